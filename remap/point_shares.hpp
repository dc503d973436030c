#pragma once
// What part of an element a quadrature point stands for (docs/theory.md: Transport).

#include <cstddef>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "mesh/quadrature.hpp"

namespace polyslip::remap {

/// The point of the rule nearest to local coordinates, in barycentric ones, so that no corner is
/// set apart; the first of several.
std::size_t nearest_point(std::span<const mesh::QuadraturePoint> rule, const core::Vec3& xi);

/// [points] local coordinates of the centroid of each point's share, the part of the reference
/// element to which it is the nearest. To 1e-3.
std::vector<core::Vec3> share_centroids(std::span<const mesh::QuadraturePoint> rule);

}  // namespace polyslip::remap
