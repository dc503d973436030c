// Single crystals through the whole model against their closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rotation.hpp"
#include "solver/model.hpp"
#include "support/crystal_boxes.hpp"
#include "support/slip_closed_form.hpp"

namespace polyslip::solver {
namespace {

struct Case {
  std::string name;
  core::Mat3 axes;  // columns: crystal axes in the sample frame
  bool tension;
  double slip;    // sum|gamma|/|eps_zz|: known at m = 0.12 or from Schmid factors
  bool yy_known;  // Goss: no active system feels sigma_yy, which keeps most of its elastic value
};

core::Mat3 goss() {
  core::Mat3 q;  // crystal [001] along x, [110] along z
  const double s = std::sqrt(0.5);
  q << 0, 0, 1, s, -s, 0, s, s, 0;
  return q;
}

core::Mat3 cube111() {
  core::Mat3 q;  // [111] along z
  q.row(2) = core::Vec3(1, 1, 1).normalized();
  q.row(0) = core::Vec3(1, -1, 0).normalized();
  q.row(1) = q.row(2).cross(q.row(0));
  return q;
}

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class SingleCrystal : public ::testing::TestWithParam<Case> {};

TEST_P(SingleCrystal, StressAndSlipAreThoseOfTheClosedForm) {
  const Case& c = GetParam();
  material::MaterialOptions options;
  options.h0 = 0;
  const double m = options.rate_sensitivity;
  const auto law = material::make_fcc_law(options);
  LoadingOptions loading;
  loading.max_strain_increment = 0.005;
  loading.initial_strain_increment = 1e-3;
  SolverOptions solver;
  solver.newton_tolerance = 1e-6;
  const auto snapshot = tests::crystal_box(MPI_COMM_WORLD, *law, core::from_matrix(c.axes));
  Model model(MPI_COMM_WORLD, snapshot, *law,
              c.tension ? tests::tension(1) : make_boundary(loading, {1, 1, 1}), loading, solver,
              {});
  StepRecord r;
  while (model.strain() < 0.03) r = model.step(0.03);
  const mesh::Snapshot before = model.snapshot();
  while (model.strain() < 0.04) r = model.step(0.04);
  const mesh::Snapshot after = model.snapshot();

  const auto expected = tests::closed_form(c.axes, m, c.tension ? 1 : -1, !c.tension);
  EXPECT_NEAR(expected.slip_rate, c.slip, 2e-4);
  for (int i = 0; i < 3; ++i) {
    if (i == 1 && !c.yy_known) continue;
    EXPECT_NEAR(r.stress[i], options.g0 * expected.stress[i], 1e-3 * std::abs(r.stress[2])) << i;
  }
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(r.stress[i], 0, 1e-3 * std::abs(r.stress[2])) << i;
  EXPECT_GT(std::abs(r.stress[2]), 10);
  if (!tests::on_root(MPI_COMM_WORLD)) return;
  const auto &slip0 = before.find("slip")->values, &slip1 = after.find("slip")->values;
  const auto &q0 = before.find("orientation")->values, &q1 = after.find("orientation")->values;
  ASSERT_FALSE(slip0.empty());
  for (std::size_t i = 0; i < slip0.size(); ++i) {
    ASSERT_NEAR((slip1[i] - slip0[i]) / 0.01, expected.slip_rate, 2e-3);
    for (std::size_t k = 0; k < 4; ++k) ASSERT_NEAR(q0[4 * i + k], q1[4 * i + k], 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Closed, SingleCrystal,
    ::testing::Values(Case{"tension001", core::Mat3::Identity(), true, 8 * 0.30619, true},
                      Case{"tension111", cube111(), true, 6 * 0.61237, true},
                      Case{"cube", core::Mat3::Identity(), false, 2.4571, true},
                      Case{"goss", goss(), false, 2.4495, false}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace polyslip::solver
