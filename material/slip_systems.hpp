#pragma once
// Slip systems generated from one system and the symmetry of the crystal.

#include <span>
#include <vector>

#include "core/types.hpp"

namespace polyslip::material {

/// A slip system in crystal axes: unit normal n of the plane and unit direction s in it.
struct SlipSystem {
  core::Vec3 normal;
  core::Vec3 direction;
};

/// Every system that `rotations` make of `seed`, in order of appearance. Systems that differ by the
/// sign of normal or direction only are one system: slip in the negative sense is not another.
std::vector<SlipSystem> slip_systems(const SlipSystem& seed,
                                     std::span<const core::Quaternion> rotations);

/// The 12 {111}<110> systems of an FCC crystal (Quey et al. 2011, section 3.1).
std::vector<SlipSystem> fcc_slip_systems();

}  // namespace polyslip::material
