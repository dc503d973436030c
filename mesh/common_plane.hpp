#pragma once
// The plane that a face of a deformed domain still is.

#include <optional>
#include <span>

#include "core/types.hpp"

namespace polyslip::mesh {

/// Unit normal, and the range of normal . x over points, at most their rounding wide.
struct CommonPlane {
  core::Vec3 normal;
  double low = 0, high = 0;
};

/// The plane that all points lie in, if they do: that of the unit normal `own`, or the one that the
/// face's `area` (the integral of its normal) has turned to, in simple shear.
std::optional<CommonPlane> common_plane(const core::Vec3& own, const core::Vec3& area,
                                        std::span<const core::Vec3> points, double rounding);

/// Rounding of positions in a domain of this size, for common_plane.
double plane_rounding(const core::Vec3& size);

}  // namespace polyslip::mesh
