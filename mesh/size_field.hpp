#pragma once
// Sizes and nodes on vertices and edges (0D and 1D meshing, sections 2.2.1.1, 2.2.1.2, 2.3.1 and
// 2.3.2 of the paper). Lengths are those of the frame scaled component by component.

#include <vector>

#include "core/types.hpp"
#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// An edge's chain of quadratic segments, parametrised by its arc length in the scaled frame: the
/// "equivalent straight configuration" of section 2.3.2.
class CurvedEdge {
 public:
  CurvedEdge(const EdgeShape& shape, const core::Vec3& scale);
  /// In the scaled frame.
  double length() const { return ends_.back(); }
  /// Point (unscaled) at arc length s, clamped to 0 ... length(); the ends are met exactly.
  core::Vec3 at(double s) const;

 private:
  /// Length of segment i from its start to the parameter t in 0 ... 1.
  double partial_length(int segment, double t) const;

  const EdgeShape* shape_;
  core::Vec3 scale_;
  std::vector<double> ends_;  ///< arc length at the start of each segment, and at the end
};

/// c_l by entity: of a grain what the options say, of a face and an edge the least of the grains
/// around.
struct ElementSizes {
  std::vector<double> grains, faces, edges;
};
/// Throws InputError if there is a list of sizes for another number of grains.
ElementSizes element_sizes(const Topology& topology, const MeshingOptions& options);

/// Characteristic length of each vertex: the least c_l of its edges, or p_l times its shortest edge
/// if that is less. `edge_lengths` as of CurvedEdge::length; `edge_sizes`: c_l of each edge.
std::vector<double> vertex_sizes(const Topology& topology, const std::vector<double>& edge_lengths,
                                 const std::vector<double>& edge_sizes, double progression_factor);

/// Arc lengths 0 ... length of the nodes of an edge whose vertices have the sizes `from` and `to`:
/// elements grow by p_l from the vertices up to c_l; adjacent ones differ by no more than p_l (to
/// 1e-9). `least_count` or more elements. Throws RecoverableError for lengths or sizes that are not
/// positive.
std::vector<double> edge_nodes(double length, double from, double to, double element_size,
                               double progression_factor, int least_count = 1);

/// Largest ratio of the lengths of adjacent elements; infinite if nodes are out of order.
double largest_progression(const std::vector<double>& arcs);

/// What the nodes of an edge are graded by: see edge_nodes.
struct EdgeGrading {
  double from = 0, to = 0, element_size = 0, progression_factor = 2;
};

/// Gives an edge, whose nodes are at `arcs`, a node at `arc`, so that adjacent lengths differ by no
/// more than p_l: by the first of these that does: its near node moved there, if it is near; one
/// put in; the near one moved from further; both parts graded anew, finer and finer at the node.
/// Otherwise an even grading with one element more, as far from it towards the node as can be.
std::vector<double> with_node_at(const std::vector<double>& arcs, double arc,
                                 const EdgeGrading& grading);

}  // namespace polyslip::mesh
