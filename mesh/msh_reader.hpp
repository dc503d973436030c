#pragma once
// Meshes made elsewhere.

#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/length_unit.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

struct MeshFile {
  Mesh mesh;
  std::vector<int> grain_ids;  ///< [cell] the file's number of each grain, ascending
  /// [element] its place among the tetrahedra of the file, from 0: tables of the elements can be
  /// written or compared in the file's order.
  std::vector<int> file_rows;
  /// One a cell, where the file has them (`$ElsetOrientations`; see mesh/orientation_block.hpp).
  std::optional<std::vector<core::Quaternion>> orientations;
  /// A point of the file lies at (x - origin) * scale here.
  core::Vec3 origin{0, 0, 0};
  double scale = 1;
};

/// Reads Gmsh's formats 2.2 and 4.1, ASCII and binary, `.gz` too: tetrahedra of order 1 or 2, not
/// mixed, with grains as their physical volumes (the elementary ones where no element has a
/// physical one). Elements of lower dimension and sections that are not known are skipped; nodes of
/// no tetrahedron are left out. The domain must be a box along the axes; it is moved to the origin
/// and, for LengthUnit::grain, scaled to grains of unit mean volume (not at all where it is so
/// within 1e-9). Nodes keep their order; tetrahedra are sorted by grain and else keep theirs.
/// Topology, triangles and lines are found from the grains (mesh/grain_topology.hpp). check()
/// passes. Throws InputError
/// "<path>:<line>: <what>", or "<path>: <what>" for what several lines have in common.
MeshFile read_msh(const std::string& path, LengthUnit unit = LengthUnit::grain);

}  // namespace polyslip::mesh
