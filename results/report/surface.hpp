#pragma once
// What can be seen of a mesh: the triangles of grain and domain boundaries, and what lies behind.

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace polyslip::results::report {

/// Corners of the boundary triangles only, so triangles are flat. A triangle on the domain boundary
/// has one side, one between two grains two.
struct Surface {
  std::vector<int> nodes;  ///< the mesh's node of each of the surface's nodes, increasing
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< into `nodes`, out of grains[0]
  std::vector<std::array<std::uint32_t, 2>> grains;     ///< from 1; the second is 0 outside
  std::vector<std::uint8_t> lines;  ///< bit i: from corner i to i + 1 runs an edge of the topology
  /// Element behind each side: those of the first grains, a triangle each, then those of the second
  /// grains, of the triangles that have one.
  std::vector<int> elements;
};

/// InternalError if a triangle is not a facet of an element of each of its grains.
Surface surface_of(const mesh::Mesh& mesh);

}  // namespace polyslip::results::report
