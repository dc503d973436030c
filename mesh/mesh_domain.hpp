#pragma once
// The convex domain that a mesh fills, found from its surface.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/domain.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// Planes and their names; none if the mesh fills its bounding box.
struct MeshWalls {
  std::vector<Plane> planes;  ///< outwards
  std::vector<std::string> names;
};

/// The planes of the facets that only one tetrahedron has, where there is a node of the mesh beyond
/// none of them: those of a convex body that is no box along the axes. Nothing for a box, and for
/// bodies that are not convex. Planes within 1e-6 of the smallest side are one. `surfaces`: names
/// of triangles by their sorted corners; planes without one are f1, f2, ... in the order of
/// elements.
std::optional<MeshWalls> find_walls(const Mesh& mesh,
                                    const std::map<std::array<int, 3>, std::string>& surfaces);

}  // namespace polyslip::mesh
