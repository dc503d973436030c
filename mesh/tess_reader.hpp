#pragma once
// Tessellations in Neper's .tess format.

#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/length_unit.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

struct TessellationFile {
  Tessellation tessellation;
  /// One a cell, where the file has them (`*ori`; see mesh/orientation_block.hpp).
  std::optional<std::vector<core::Quaternion>> orientations;
  std::vector<int> cell_ids;               ///< `*id`; 1, 2, ... in files without
  std::vector<double> seed_weights;        ///< of a Laguerre tessellation; empty without seeds
  std::optional<std::string> crystal;      ///< `*crysym`
  std::optional<std::vector<int>> groups;  ///< `*group`, one a cell
  /// A point of the file lies at (x - origin) * scale here.
  core::Vec3 origin{0, 0, 0};
  double scale = 1;
};

/// Reads Neper's .tess format from version 3 on, as its documentation describes it, `.gz` too: a
/// tessellation of a convex domain, regularised or not. It is moved so that its bounding box begins
/// at the origin and, for LengthUnit::grain, scaled to cells of unit mean volume (not at all where
/// it is so within 1e-9), and vertices on the domain's faces are put on them. A box along the axes
/// is one whatever the file calls it; of another domain the section **domain gives the faces, and a
/// curved one becomes a facet for each plane in it. Cells, faces, edges and vertices keep the
/// file's order. Faces keep their planes and the master points of their triangles: a vertex, or for
/// 0 the mean of the vertices (Neper's centroid of the area moves the surface of a face little);
/// where a face would be folded, the point that distorts it least. Cells without a seed get the
/// mean of their vertices. check() passes. Of a periodic tessellation, whose whole cells stick out
/// of the domain, the box of **domain begins at the origin, and secondaries are put on their
/// primaries' translates. Throws InputError "<path>:<line>: <what>", or "<path>: <what>" for what
/// several lines have in common.
TessellationFile read_tess(const std::string& path, LengthUnit unit = LengthUnit::grain);

}  // namespace polyslip::mesh
