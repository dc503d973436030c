#pragma once
// Surfaces that are no discs (closed ones, ones with holes, ones that touch themselves) in parts
// that are.

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace polyslip::mesh {

/// Triangles, and which two go on into each other across a common side: of the same orientation.
struct TriangleSurface {
  std::vector<std::array<int, 3>> triangles;  ///< corners: indices of nodes
  std::vector<std::pair<int, int>> joints;    ///< triangles
};

/// Whether a disc, by its triangles, may stay as it is.
using FitPart = std::function<bool(const std::vector<int>& triangles)>;

/// Part of each triangle, numbered from 0 by their first triangles: each part is connected, a disc,
/// i.e. V - E + F = 1 and it has one boundary, which meets no node twice, and fit, or of no more
/// than a few triangles. A connected surface that is so is one part. Others are cut half way
/// between two triangles that are far apart, along short sides, until all parts are so.
std::vector<int> disc_parts(
    const TriangleSurface& surface, const std::vector<core::Vec3>& nodes,
    const FitPart& fit = [](const std::vector<int>&) { return true; });

}  // namespace polyslip::mesh
