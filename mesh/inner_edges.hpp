#pragma once
// Edges inside a triangle mesh.

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {

/// Edges (a < b) that belong to two triangles, with the first such triangle and its side.
inline std::vector<std::array<int, 4>> inner_edges(
    const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 4>> all, inner;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int a = triangles[t][triangle_edges[i][0]], b = triangles[t][triangle_edges[i][1]];
      all.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), i});
    }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i + 1 < all.size(); ++i)
    if (all[i][0] == all[i + 1][0] && all[i][1] == all[i + 1][1]) inner.push_back(all[i]);
  return inner;
}

}  // namespace polyslip::mesh
