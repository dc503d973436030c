#pragma once
// Boxes of crystals and loads for tests of the model.

#include <mpi.h>

#include <cmath>
#include <string>
#include <vector>

#include "solver/boundary.hpp"
#include "solver/model.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::tests {

inline bool on_root(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank == 0;
}

/// Unit quaternions from a fixed sequence.
inline std::vector<core::Quaternion> some_orientations(int n) {
  std::vector<core::Quaternion> out;
  for (int i = 0; i < n; ++i) {
    core::Quaternion q(std::cos(1.0 + 2.3 * i), std::sin(0.4 + 1.1 * i), std::cos(0.2 + 3.7 * i),
                       std::sin(2.0 + 5.3 * i));
    q.normalize();
    out.push_back(q);
  }
  return out;
}

/// One crystal, 24 elements or so.
inline mesh::Snapshot crystal_box(MPI_Comm comm, const material::CrystalLaw& law,
                                  const core::Quaternion& orientation) {
  if (!on_root(comm)) return {};
  return solver::initial_snapshot(box_mesh({2, 2, 1}, {1, 1, 1}), {orientation}, law);
}

/// A few slabs of different orientations on a distorted mesh: 216 elements.
inline mesh::Snapshot slab_box(MPI_Comm comm, const material::CrystalLaw& law,
                               const core::Quaternion& rotation = core::Quaternion::Identity(),
                               int points = 4) {
  if (!on_root(comm)) return {};
  auto m = box_mesh({4, 3, 3}, {2, 1.5, 1.2}, 4);
  distort(m, 0.1);
  for (auto& x : m.nodes) x = rotation * x;
  auto orientations = some_orientations(4);
  for (auto& q : orientations) q = rotation * q;
  return solver::initial_snapshot(std::move(m), orientations, law, points);
}

/// Uniaxial tension along z with free sides: strain = ln(h/h0).
inline solver::Boundary tension(double height) {
  const auto zero = [](double) { return 0.0; };
  solver::Boundary b;
  b.faces = {{0, 0, zero}, {2, 1, zero}, {4, 2, zero}, {5, 2, [height](double e) {
                                                          return height * std::exp(e);
                                                        }}};
  b.mean_gradient = [](double e) -> core::Mat3 {
    return core::Vec3(std::exp(-e / 2), std::exp(-e / 2), std::exp(e)).asDiagonal();
  };
  return b;
}

}  // namespace polyslip::tests
