#pragma once
// Meshes a planar polygon whose boundary nodes are given.

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace polyslip::mesh {

struct PlanarProblem {
  std::vector<Eigen::Vector2d> boundary;  ///< in order, turning left; edges are not split
  std::vector<double> sizes;              ///< [boundary] characteristic length of each node
  double element_size = 0.5;              ///< c_l
  double progression_factor = 2.0;        ///< p_l, > 1: sizes grow by it from element to element
  /// Pairs of boundary nodes that no inner edge may join (it is cut in two instead).
  std::vector<std::array<int, 2>> forbidden_edges;
};

struct PlanarMesh {
  std::vector<Eigen::Vector2d> points;        ///< the boundary's, then inner ones
  std::vector<std::array<int, 3>> triangles;  ///< turning left, positive areas
  std::string fault;                          ///< why there are none
};

/// 2 r_in / R_circ of a triangle; 1 for an equilateral one, negative if it turns right.
double radius_ratio(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// Why no mesh is possible; empty if there is no reason: three nodes or more, finite, a polygon
/// that neither meets itself nor turns right.
std::string boundary_fault(const PlanarProblem& problem);

/// Delaunay triangulation, frontal point insertion (Rebay, J. Comput. Phys. 106, 1993) to the
/// sizes, smoothing. Predicates are exact, on a grid of 2^-27 of the polygon's extent. Returns
/// whether there is a mesh; if not, it holds the fault: the polygon is not simple, an edge that is
/// forbidden could not be cut, or a triangle that is positive on the grid is not so off it.
bool mesh_polygon(const PlanarProblem& problem, PlanarMesh& mesh);

}  // namespace polyslip::mesh
