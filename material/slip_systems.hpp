#pragma once
// Slip systems, generated from one of them and the symmetry of the crystal. A family is data: the
// normal of a plane, a direction in it, the rotations of the crystal.

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace polyslip::material {

/// A slip system in crystal axes: unit normal n of the plane and unit direction s in it, the first
/// component of each that is not zero positive.
struct SlipSystem {
  core::Vec3 normal;
  core::Vec3 direction;
};

/// One slip system, of any length, and the rotations that make the others of it.
struct SlipFamily {
  core::Vec3 normal;
  core::Vec3 direction;
  std::span<const core::Quaternion> rotations;
};

/// Every system of the family. Systems that differ by the sign of normal or direction only are one
/// system: slip in the negative sense is not another. Ordered by plane, those of larger components
/// first, and in a plane by direction, those of smaller absolute components first. Throws
/// core::InternalError if the direction does not lie in the plane or one of the two is zero.
std::vector<SlipSystem> slip_systems(const SlipFamily& family);

/// The 12 {111}<110> systems of an FCC crystal (Quey et al. 2011, section 3.1): (111)[01-1],
/// (111)[10-1], (111)[1-10], (11-1)[011], (11-1)[101], (11-1)[1-10], (1-11)[011], (1-11)[10-1],
/// (1-11)[110], (1-1-1)[01-1], (1-1-1)[101], (1-1-1)[110].
std::vector<SlipSystem> fcc_slip_systems();

/// The 12 proper rotations of a hexagonal crystal, identity first: c along z, one a along x.
const std::array<core::Quaternion, 12>& hexagonal_symmetries();

/// The normal of the plane (h k -(h+k) l), in those axes, for an axial ratio c/a; not of unit
/// length.
core::Vec3 hexagonal_normal(double h, double k, double l, double axial_ratio);
/// The direction [u v -(u+v) w] in four indices, in those axes; not of unit length.
core::Vec3 hexagonal_direction(double u, double v, double w, double axial_ratio);

}  // namespace polyslip::material
