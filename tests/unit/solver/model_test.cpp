// The model under homogeneous and simple loads with the test law: what does not need a crystal.
#include "solver/model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/error.hpp"
#include "mesh/quadrature.hpp"
#include "solver/exchange.hpp"
#include "support/box_mesh.hpp"
#include "support/elastic_law.hpp"

namespace polyslip::solver {
namespace {

mesh::Snapshot box(const material::CrystalLaw& law, double distortion = 0, int points = 4) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) return {};
  auto m = tests::box_mesh({4, 3, 3}, {2, 1.5, 1.2}, 2);
  if (distortion > 0) tests::distort(m, distortion);
  return initial_snapshot(
      std::move(m), {core::Quaternion::Identity(), core::Quaternion::Identity()}, law, points);
}

Boundary linear_motion(const core::Mat3& gradient) {
  Boundary b;
  b.mean_gradient = [gradient](double s) -> core::Mat3 {
    return core::Mat3::Identity() + s * gradient;
  };
  b.all = [f = b.mean_gradient](const core::Vec3& x, double s) -> core::Vec3 { return f(s) * x; };
  return b;
}

SolverOptions tight() {
  SolverOptions o;
  o.newton_tolerance = 1e-9;
  o.linear_tolerance = 1e-9;
  return o;
}

LoadingOptions one_step(double size) {
  LoadingOptions l;
  l.max_strain_increment = size;
  l.fixed_increment = true;
  return l;
}

class PatchTest : public ::testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(PatchTest, AConstantGradientGivesAConstantStress) {
  const double mu = 30, bulk = 300;
  const tests::ElasticLaw law(mu, bulk);
  core::Mat3 g;
  g << 0.3, 0.2, -0.1, 0.4, -0.6, 0.15, 0.05, -0.3, 0.5;
  auto options = tight();
  std::tie(options.element, options.quadrature_points) = GetParam();
  const int points = options.quadrature_points;
  // The predictor must not know the answer.
  Boundary boundary = linear_motion(g);
  boundary.mean_gradient = [](double) -> core::Mat3 { return core::Mat3::Identity(); };
  const double size = 1e-3;
  Model model(MPI_COMM_WORLD, box(law, 0.15, points), law, boundary, one_step(size), options, {});
  const StepRecord r = model.step(size);
  EXPECT_GT(r.newton_iterations, 0);
  const mesh::Snapshot s = model.snapshot();
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) return;
  const core::Mat3 e = 0.5 * size * (g + g.transpose());
  const double p = bulk * std::log((core::Mat3::Identity() + size * g).determinant());
  const auto expected = [&](int i, int j) {
    return 2 * mu * (e(i, j) - (i == j ? e.trace() / 3 : 0)) + (i == j ? p : 0);
  };
  const double want[6] = {expected(0, 0), expected(1, 1), expected(2, 2),
                          expected(1, 2), expected(2, 0), expected(0, 1)};
  const auto* stress = s.find("cauchy_stress", mesh::Location::quadrature_point);
  ASSERT_NE(stress, nullptr);
  ASSERT_EQ(stress->values.size(), s.mesh.tetrahedra.size() * 6 * static_cast<std::size_t>(points));
  for (std::size_t i = 0; i < stress->values.size(); ++i)
    ASSERT_NEAR(stress->values[i], want[i % 6], 1e-7 * bulk * size) << i;
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(r.stress[c], want[c], 1e-7 * bulk * size);
}

INSTANTIATE_TEST_SUITE_P(Solver, PatchTest,
                         ::testing::Combine(::testing::Values("mixed", "displacement"),
                                            ::testing::ValuesIn(mesh::tet_quadrature_sizes)));

TEST(Model, PlaneStrainOfAnElasticBlockBalances) {
  const double mu = 30, bulk = 100;
  const tests::ElasticLaw law(mu, bulk);
  LoadingOptions loading = one_step(1e-4);
  Model model(MPI_COMM_WORLD, box(law, 0.1), law, loading, tight(), {});
  const StepRecord r = model.step(1e-4);
  // Plane stress across x, plane strain across y: sigma_zz = -E/(1 - nu^2) eps.
  const double E = 9 * bulk * mu / (3 * bulk + mu),
               nu = (3 * bulk - 2 * mu) / (2 * (3 * bulk + mu));
  EXPECT_NEAR(r.stress[2] / (-E / (1 - nu * nu) * 1e-4), 1, 1e-3);
  EXPECT_NEAR(r.stress[1] / (-nu * E / (1 - nu * nu) * 1e-4), 1, 1e-3);
  EXPECT_LT(std::abs(r.stress[0]), 1e-6 * std::abs(r.stress[2]));
  EXPECT_NEAR(r.fz_z1, r.stress[2] * 2 * 1.5, 1e-3 * std::abs(r.fz_z1));
  EXPECT_LT(r.fz_z1, 0);
  EXPECT_NEAR(r.face_forces[4][2], -r.fz_z1, 1e-8 * std::abs(r.fz_z1));
  EXPECT_NEAR(r.face_forces[2][1], -r.fy_y1, 1e-8 * std::abs(r.fz_z1));
  EXPECT_NEAR(r.face_forces[5][0], 0, 1e-8 * std::abs(r.fz_z1));
  EXPECT_DOUBLE_EQ(r.strain, 1e-4);
  EXPECT_DOUBLE_EQ(r.time, 1e-4);
}

TEST(Model, AFailedPointCutsTheStepAndTheSizeRecovers) {
  const tests::ElasticLaw law(30, 100, 1.5e-3);
  LoadingOptions loading = one_step(4e-3);
  int lines = 0;
  Model model(MPI_COMM_WORLD, box(law), law, loading, SolverOptions{},
              [&](const std::string&) { ++lines; });
  const StepRecord r = model.step(4e-3);
  EXPECT_EQ(r.cuts, 2);
  EXPECT_DOUBLE_EQ(r.step_size, 1e-3);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  EXPECT_EQ(lines, rank == 0 ? 2 : 0);
  double strain = r.strain;
  for (int i = 0; i < 10 && strain < 4e-3; ++i) strain = model.step(4e-3).strain;
  EXPECT_EQ(strain, 4e-3);
}

TEST(Model, FailureEverywhereIsRecoverableAndLeavesTheState) {
  const tests::ElasticLaw law(30, 100, 1e-9);
  LoadingOptions loading = one_step(1e-3);
  loading.min_strain_increment = 1e-4;
  Model model(MPI_COMM_WORLD, box(law), law, loading, SolverOptions{}, {});
  try {
    model.step(1e-3);
    ADD_FAILURE() << "no step can converge";
  } catch (const StepFailure& failure) {
    EXPECT_EQ(failure.tried.cuts, 4);  // 1, 0.5, 0.25, 0.125 thousandths
  }
  EXPECT_EQ(model.strain(), 0);
  loading.min_strain_increment = 1e-9;
  Model patient(MPI_COMM_WORLD, box(law), law, loading, SolverOptions{}, {});
  EXPECT_THROW(patient.step(1e-3, 3), core::RecoverableError);
  const auto s = model.snapshot();
  for (const auto& f : s.fields)
    if (f.name == "displacement") {
      for (double u : f.values) ASSERT_EQ(u, 0);
    }
}

TEST(Model, ShowsRankByRankWhatItsSnapshotHolds) {
  const tests::ElasticLaw law(30, 100);
  Model model(MPI_COMM_WORLD, box(law, 0.1), law, one_step(1e-4), tight(), {});
  model.step(1e-4);
  const mesh::Snapshot whole = model.snapshot();
  std::size_t pieces = 0;
  model.show([&](const mesh::Snapshot& outline, const mesh::FieldReader& read) {
    EXPECT_EQ(outline.mesh.nodes, whole.mesh.nodes);
    EXPECT_EQ(outline.history, whole.history);
    ASSERT_EQ(outline.fields.size(), whole.fields.size());
    for (std::size_t f = 0; f < outline.fields.size(); ++f) {
      const mesh::Field& field = outline.fields[f];
      ASSERT_EQ(field.name, whole.fields[f].name);
      EXPECT_TRUE(field.values.empty());
      const std::size_t owners = mesh::owner_count(outline, field);
      std::vector<double> values;
      for (std::size_t first = 0; first < owners; first += 17, ++pieces) {
        const auto some = read(field, first, std::min(first + 17, owners));
        values.insert(values.end(), some.begin(), some.end());
      }
      EXPECT_EQ(values, whole.fields[f].values) << field.name;
    }
  });
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  EXPECT_EQ(pieces > 0, rank == 0);
}

/// Each node is owned once, each element has its corners where the snapshot has them, and initial
/// positions are those of the mesh that the model began with.
TEST(Model, ItsPartsMakeUpTheBody) {
  const tests::ElasticLaw law(30, 100);
  const mesh::Snapshot start = box(law, 0.1);
  Model model(MPI_COMM_WORLD, start, law, one_step(1e-3), tight(), {});
  model.step(1e-3);
  const MeshPart part = model.part();
  const mesh::Snapshot now = model.snapshot();
  ASSERT_EQ(part.initial.size(), part.positions.size());
  ASSERT_EQ(part.rates.size(), part.positions.size());
  std::array<double, 8> sums{static_cast<double>(part.elements.size()),
                             static_cast<double>(part.owned_nodes)};
  for (std::size_t n = 0; n < part.owned_nodes; ++n)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto c = static_cast<Eigen::Index>(i);
      sums[2 + i] += part.initial[n][c];
      sums[5 + i] += part.positions[n][c] * part.positions[n][c];
    }
  for (const auto& e : part.elements) {
    const auto x = [&](std::size_t i) { return part.positions[static_cast<std::size_t>(e[i])]; };
    EXPECT_GT((x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)), 0);
    EXPECT_LT((x(4) - (x(0) + x(1)) / 2).norm(), 0.1 * (x(1) - x(0)).norm());
  }
  sum(MPI_COMM_WORLD, sums.data(), 8);
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  EXPECT_EQ(sums[0], static_cast<double>(now.mesh.tetrahedra.size()));
  EXPECT_EQ(sums[1], static_cast<double>(now.mesh.nodes.size()));
  core::Vec3 initial = core::Vec3::Zero(), squares = core::Vec3::Zero();
  for (const auto& x : start.mesh.nodes) initial += x;
  for (const auto& x : now.mesh.nodes) squares += x.cwiseProduct(x);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(sums[2 + i], initial[c], 1e-9 * initial.norm());
    EXPECT_NEAR(sums[5 + i], squares[c], 1e-9 * squares.norm());
  }
}

TEST(Model, AFailureInReadingItsFieldsReachesEveryRank) {
  const tests::ElasticLaw law(30, 100);
  Model model(MPI_COMM_WORLD, box(law), law, one_step(1e-4), tight(), {});
  EXPECT_THROW(model.show([](const mesh::Snapshot& outline, const mesh::FieldReader& read) {
    read(outline.fields.front(), 0, 1);
    throw core::InputError("the disk is full");
  }),
               core::InputError);
  EXPECT_EQ(model.step(1e-4).strain, 1e-4);
}

TEST(Model, AnInvertedElementCutsTheStep) {
  const tests::ElasticLaw law(30, 100);
  Boundary b = linear_motion(-core::Mat3::Identity() * 1e-3);
  // Turned inside out on the way to s = 1, small for s <= 0.3.
  b.all = [](const core::Vec3& x, double s) -> core::Vec3 {
    return s > 0.3 ? core::Vec3(-x) : core::Vec3((1 - 1e-3 * s) * x);
  };
  Model model(MPI_COMM_WORLD, box(law), law, b, one_step(1.0), SolverOptions{}, {});
  const StepRecord r = model.step(1.0);
  EXPECT_EQ(r.cuts, 2);
  EXPECT_DOUBLE_EQ(r.step_size, 0.25);
}

TEST(Model, AnotherNumberOfPointsThanTheSnapshotsIsRefusedOnEveryRank) {
  const tests::ElasticLaw law(30, 100);
  SolverOptions options;
  options.quadrature_points = 15;
  EXPECT_THROW(Model(MPI_COMM_WORLD, box(law), law, LoadingOptions{}, options, {}),
               core::InternalError);
  options.quadrature_points = 5;
  EXPECT_THROW(Model(MPI_COMM_WORLD, box(law), law, LoadingOptions{}, options, {}),
               core::InternalError);
}

TEST(Model, ASnapshotWithoutStateIsRefusedOnEveryRank) {
  const tests::ElasticLaw law(30, 100);
  mesh::Snapshot s = box(law);
  s.fields.clear();
  EXPECT_THROW(Model(MPI_COMM_WORLD, s, law, LoadingOptions{}, SolverOptions{}, {}),
               core::InternalError);
}

}  // namespace
}  // namespace polyslip::solver
