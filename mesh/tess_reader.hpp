#pragma once
// Tessellations made elsewhere.

#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

struct TessellationFile {
  Tessellation tessellation;
  /// One a cell, where the file has them (`*ori`; see mesh/orientation_block.hpp).
  std::optional<std::vector<core::Quaternion>> orientations;
};

/// Reads Neper's .tess format from version 3 on, as its documentation describes it: a tessellation
/// of a box whose edges lie along the axes, regularised or not; `.gz` too. It is moved to the
/// origin and scaled to cells of unit mean volume (not at all where it is so within 1e-9), and
/// vertices on the box are put exactly on it. Cells, faces, edges and vertices keep the file's
/// numbers, less one. Faces keep their planes and the master points of their triangles: a vertex,
/// or for 0 the barycentre of the vertices; where a face would be folded, the point that distorts
/// it least. Cells without a seed get the mean of their vertices. check() passes. Throws InputError
/// "<path>:<line>: <what>", or "<path>: <what>" for what several lines have in common.
TessellationFile read_tess(const std::string& path);

}  // namespace polyslip::mesh
