#pragma once
// Faces that stay flat under a given mean traction: one unknown each, bordering the linear system
// (docs/theory-solver.md, Planar faces).

#include <array>
#include <cstdint>
#include <vector>

#include "solver/boundary.hpp"
#include "solver/partition.hpp"

namespace polyslip::solver {

/// The planar faces of a boundary on this rank's mesh. Collective where said.
class PlanarFaces {
 public:
  PlanarFaces(const LocalMesh& local, const Boundary& boundary);

  std::size_t count() const { return faces_.size(); }
  /// [local_nodes][3] 1 for the dofs of face k, 0 elsewhere
  std::vector<double> direction(std::size_t k) const;
  /// From the far end of the body to face k, along its normal: negative for a low face. Collective.
  double extent(std::size_t k, const std::vector<double>& x) const;
  /// [local_nodes][3] the motion that stretches the body by one unit at face k, nothing at the far
  /// end. Collective.
  std::vector<double> stretch(std::size_t k, const std::vector<double>& x) const;
  /// Local elements with a node on one of the faces.
  const std::vector<int>& elements() const { return elements_; }
  bool owns(std::size_t dof) const { return is_planar_[dof] != 0; }

  /// Every node of a face at the mean of their coordinates. Collective.
  void flatten(std::vector<double>& x) const;
  /// Sum of `values` [local_nodes][3] over the owned dofs of each face. Collective.
  std::vector<double> sums(const std::vector<double>& values) const;
  /// Forces out of balance on each face, sum f - (outward) traction times area. forces:
  /// [local_nodes][3]; x: positions; path: of the load. Collective.
  std::vector<double> residuals(const std::vector<double>& forces, const std::vector<double>& x,
                                double path) const;
  /// Area of each face projected on its plane [L^2]. Collective.
  std::vector<double> areas(const std::vector<double>& x) const;

 private:
  const LocalMesh& local_;
  std::vector<PlanarFace> faces_;
  std::vector<std::vector<std::size_t>> dofs_;  // of each face, owned first
  std::vector<std::size_t> owned_;              // how many of them
  std::vector<std::uint8_t> is_planar_;
  /// Coordinates of the face and of the far end.
  std::array<double, 2> ends(std::size_t k, const std::vector<double>& x) const;
  std::vector<int> elements_;
  /// Six-node triangles of each face: corners, then mid nodes after each corner.
  std::vector<std::vector<std::array<int, 6>>> triangles_;
};

/// Solution of a[row][column] x = b by elimination with row pivoting; for one unknown a face.
std::vector<double> solve_dense(std::vector<std::vector<double>> a, std::vector<double> b);

}  // namespace polyslip::solver
