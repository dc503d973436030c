// Stresses that are out of balance, as a transport leaves them, brought to equilibrium.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "solver/model.hpp"
#include "solver/snapshot_fields.hpp"
#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

LoadingOptions plane_strain() {
  LoadingOptions o;
  o.max_strain_increment = 2e-3;
  return o;
}

/// A few slabs of crystals that flow in plane-strain compression, x free.
mesh::Snapshot flowing(const material::CrystalLaw& law) {
  Model model(MPI_COMM_WORLD, tests::slab_box(MPI_COMM_WORLD, law), law, plane_strain(), {}, {});
  while (model.strain() < 0.01) model.step(0.01);
  return model.snapshot();
}

/// Elastic strains of every second element smaller by this share.
void disturb(mesh::Snapshot& snapshot, double share) {
  for (auto& f : snapshot.fields) {
    if (f.name != "elastic_strain") continue;
    const std::size_t size = f.values.size() / snapshot.mesh.tetrahedra.size();
    for (std::size_t i = 0; i < f.values.size(); ++i)
      if (i / size % 2 == 0) f.values[i] *= 1 - share;
  }
}

/// Mean over the body of the element stresses' component; on rank 0.
double mean(const mesh::Snapshot& s, std::size_t component) {
  const auto stress = values_of(s, field::cauchy_stress, mesh::Location::element);
  const auto volume = values_of(s, field::volume, mesh::Location::element);
  double sum = 0, total = 0;
  for (std::size_t e = 0; e < volume.size(); ++e) {
    sum += volume[e] * stress[6 * e + component];
    total += volume[e];
  }
  return sum / total;
}

TEST(Relax, BringsDisturbedStressesToBalanceWithinTheBoundary) {
  const auto law = material::make_fcc_law({});
  mesh::Snapshot start = flowing(*law);
  const bool root = tests::on_root(MPI_COMM_WORLD);
  const double before = root ? mean(start, 2) : 0;
  const auto nodes = start.mesh.nodes;
  const double time = start.time;
  if (root) disturb(start, 0.2);
  Model model(MPI_COMM_WORLD, std::move(start), *law, plane_strain(), {}, {});
  const double strain = model.strain();
  model.relax();
  EXPECT_EQ(model.strain(), strain);
  const mesh::Snapshot relaxed = model.snapshot();
  if (!root) return;
  EXPECT_EQ(relaxed.time, time);
  // No force on the free face: the mean of the stress along x, which it would bear, is zero; the
  // others are between the disturbed and the undisturbed ones.
  EXPECT_LT(std::abs(mean(relaxed, 0)), 1e-3 * std::abs(before));
  EXPECT_LT(mean(relaxed, 2) / before, 1);
  EXPECT_GT(mean(relaxed, 2) / before, 0.8);
  core::Vec3 high = nodes.front();
  for (const auto& x : nodes) high = high.cwiseMax(x);
  double farthest = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const core::Vec3 move = relaxed.mesh.nodes[n] - nodes[n];
    farthest = std::max(farthest, move.norm());
    for (int axis = 1; axis < 3; ++axis) {
      const double x = nodes[n][axis];
      if (std::abs(x) > 1e-12 && std::abs(x - high[axis]) > 1e-12) continue;
      EXPECT_NEAR(move[axis], 0, 1e-12) << n;
    }
  }
  // Elastic strains are a few 1e-4.
  EXPECT_GT(farthest, 1e-6);
  EXPECT_LT(farthest, 1e-3);
}

TEST(Relax, LeavesBalancedStressesAlone) {
  const auto law = material::make_fcc_law({});
  mesh::Snapshot start = flowing(*law);
  const bool root = tests::on_root(MPI_COMM_WORLD);
  const double before = root ? mean(start, 2) : 0;
  const auto nodes = start.mesh.nodes;
  Model model(MPI_COMM_WORLD, std::move(start), *law, plane_strain(), {}, {});
  model.relax();
  const mesh::Snapshot relaxed = model.snapshot();
  if (!root) return;
  // In the time that it takes, of a strain of 1e-6, stresses flow by up to a hundredth.
  EXPECT_NEAR(mean(relaxed, 2) / before, 1, 1e-2);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    EXPECT_LT((relaxed.mesh.nodes[n] - nodes[n]).norm(), 2e-5) << n;
}

TEST(Relax, SaysIfItCannot) {
  const auto law = material::make_fcc_law({});
  mesh::Snapshot start = flowing(*law);
  if (tests::on_root(MPI_COMM_WORLD)) disturb(start, 0.5);
  SolverOptions options;
  options.max_newton_iterations = 0;
  Model model(MPI_COMM_WORLD, std::move(start), *law, plane_strain(), options, {});
  EXPECT_THROW(model.relax(), core::RecoverableError);
}

}  // namespace
}  // namespace polyslip::solver
