#pragma once
// A conforming mesh of a polycrystal: tetrahedra of each grain, triangles of each face, lines of
// each edge, a node at each vertex. Node numbers of Gmsh throughout.

#include <array>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/domain.hpp"
#include "mesh/topology.hpp"

namespace polyslip::mesh {

/// Mid nodes of a ten-node tetrahedron (Gmsh order): node 4 + i lies between these corners.
inline constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges{
    {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
/// Mid nodes of a six-node triangle: node 3 + i lies between these corners.
inline constexpr std::array<std::array<int, 2>, 3> triangle_edges{{{0, 1}, {1, 2}, {2, 0}}};

struct Mesh {
  int order = 2;                  ///< 2: mid nodes present; 1: entries of mid nodes are -1
  std::vector<core::Vec3> nodes;  ///< positions, lengths for grains of unit mean volume
  std::vector<std::array<int, 10>> tetrahedra;  ///< positive: det(x1-x0, x2-x0, x3-x0) > 0
  std::vector<int> tetrahedron_cell;            ///< grain; tetrahedra are sorted by grain
  std::vector<std::array<int, 6>> triangles;    ///< normal out of topology.faces[f].cells[0]
  std::vector<int> triangle_face;               ///< sorted by face
  std::vector<std::array<int, 3>> lines;        ///< from, to (along the topology edge), mid
  std::vector<int> line_edge;                   ///< sorted by edge; lines of an edge in its order
  std::vector<int> vertex_nodes;                ///< [topology.vertex_count] node of each vertex
  /// Nodes of periodic vertices, edges and faces, mid nodes too: where the slave is, the master is
  /// shift * size away. Sorted by slave; no master is a slave.
  std::vector<PeriodicPair> periodic_nodes;
  Topology topology;
  Domain domain = box_domain({1, 1, 1});  ///< at zero strain
  core::Vec3 size{1, 1, 1};               ///< of its bounding box

  int element_count() const { return static_cast<int>(tetrahedra.size()); }
  int node_count() const { return static_cast<int>(nodes.size()); }
};

/// Throws InternalError with element and values unless: each interior facet is in exactly two
/// tetrahedra, each facet between two grains or on the domain boundary is exactly one triangle of
/// the right face (node for node, mid nodes too), every node is used, det J > 0 at every point of
/// the 4- and 15-point quadrature rules, tags are in range and sorted; slaves are their masters'
/// translates, number for number, and each triangle and line of a slave has its master's
/// translates.
void check(const Mesh& mesh, int threads = 1);

/// Volume of each grain: quadratic elements integrated exactly.
std::vector<double> grain_volumes(const Mesh& mesh, int threads = 1);

/// Volume of one element (exact for curved elements).
double element_volume(const Mesh& mesh, int element);

/// 3 r_in / R_circ of the straight tetrahedron through the corners; 1 for a regular one.
double radius_ratio(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c,
                    const core::Vec3& d);

struct QualitySummary {
  double min_radius_ratio = 0, mean_radius_ratio = 0;
};
QualitySummary quality(const Mesh& mesh);

/// Pairs of periodic nodes, numbered as in the mesh's file: a header, then a line
/// "slave,master,shift_x,shift_y,shift_z" each, the slave being at the master's place + shift *
/// period (of the box).
void write_periodic_nodes(const Mesh& mesh, const std::string& path);

/// Gmsh format 2.2 ASCII: grains as physical volumes, surfaces of the domain (x0 ... z1 of a box)
/// as named physical ones. Positions with 17 digits. Written beside and renamed.
void write_msh(const Mesh& mesh, const std::string& path);

}  // namespace polyslip::mesh
