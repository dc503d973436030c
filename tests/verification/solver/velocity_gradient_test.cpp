// The single crystals of tests/verification/material through the whole model, under the load
// "velocity-gradient": their closed forms in the rate-independent limit at m = 0.02, numbers at m =
// 0.12, copper's lattice spin of sqrt2/3 rad per unit strain about TD.
#include <gtest/gtest.h>

#include <cmath>

#include "../material/crystals.hpp"
#include "solver/model.hpp"
#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

using material::test::ideal_orientation;

struct Flow {
  double slip = 0, slip_spread = 0;      ///< sum|gamma| per unit of |L33| t
  core::Vec3 spin = core::Vec3::Zero();  ///< lattice spin, likewise, sample frame
};

/// A box of elements whose boundary follows `rate`; three steps in which the elastic strain, 1e-7,
/// settles, then the step that is measured. On rank 0.
Flow flow(double m, const core::Quaternion& q, const core::Mat3& rate) {
  auto options = material::test::rigid_ideal(m);
  options.c11 /= 100;  // 1,000 times aluminium
  options.c12 /= 100;
  options.c44 /= 100;
  options.g0 = options.gs = 8;
  const auto law = material::make_fcc_law(options);
  const double step = 1e-5, size = std::sqrt(2.0 / 3) * rate.norm();  // per unit of |L33|
  LoadingOptions loading;
  loading.type = "velocity-gradient";
  loading.velocity_gradient = rate;
  loading.strain_rate = size;
  loading.fixed_increment = true;
  loading.max_strain_increment = step * size;
  SolverOptions solver;
  solver.newton_tolerance = 1e-6;
  const auto snapshot = tests::crystal_box(MPI_COMM_WORLD, *law, q);
  Model model(MPI_COMM_WORLD, snapshot, *law, loading, solver, {});
  for (int i = 1; i <= 3; ++i) model.step(i * step * size);
  const mesh::Snapshot before = model.snapshot();
  model.step(4 * step * size);
  const mesh::Snapshot after = model.snapshot();
  Flow result;
  if (!tests::on_root(MPI_COMM_WORLD)) return result;
  const auto &slip0 = before.find("slip")->values, &slip1 = after.find("slip")->values;
  const auto &q0 = before.find("orientation")->values, &q1 = after.find("orientation")->values;
  const auto quaternion = [](const std::vector<double>& v, std::size_t i) {
    return core::Quaternion(v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]);
  };
  EXPECT_GE(slip1.size(), 96U);
  const auto count = static_cast<double>(slip1.size());
  for (std::size_t i = 0; i < slip1.size(); ++i) {
    const double slip = (slip1[i] - slip0[i]) / step;
    result.slip += slip / count;
    result.slip_spread =
        std::max(result.slip_spread, std::abs(slip - (slip1[0] - slip0[0]) / step));
    result.spin += 2 / (step * count) * (quaternion(q1, i) * quaternion(q0, i).conjugate()).vec();
  }
  return result;
}

TEST(VelocityGradient, SlipOfIdealOrientationsInPlaneStrain) {
  for (const auto& ideal : material::test::ideals()) {
    const auto q = ideal_orientation(ideal.plane, ideal.direction);
    const Flow sharp = flow(0.02, q, material::test::plane_strain());
    const Flow paper = flow(0.12, q, material::test::plane_strain());
    if (!tests::on_root(MPI_COMM_WORLD)) continue;
    EXPECT_NEAR(sharp.slip, ideal.limit, ideal.tolerance) << ideal.name;
    const double expected = ideal.at_012 != 0 ? ideal.at_012 : paper.slip;
    EXPECT_NEAR(paper.slip, expected, 1e-4) << ideal.name;
    EXPECT_LT(std::max(sharp.slip_spread, paper.slip_spread), 1e-4) << ideal.name;
  }
}

TEST(VelocityGradient, LatticeSpinsInPlaneStrain) {
  const Flow copper =
      flow(0.02, ideal_orientation({1, 1, 2}, {1, 1, -1}), material::test::plane_strain());
  const Flow dillamore =
      flow(0.02, ideal_orientation({4, 4, 11}, {11, 11, -8}), material::test::plane_strain());
  if (!tests::on_root(MPI_COMM_WORLD)) return;
  EXPECT_NEAR(std::abs(copper.spin[1]), std::sqrt(2.0) / 3, 1e-3);
  EXPECT_LT(std::hypot(copper.spin[0], copper.spin[2]), 1e-6);
  EXPECT_NEAR(std::abs(dillamore.spin[1]), 0.009, 1e-3);
}

TEST(VelocityGradient, SlipInUniaxialTension) {
  for (const double m : {0.02, 0.12}) {
    const Flow along001 =
        flow(m, material::test::with_axis_along_z({0, 0, 1}), material::test::tension_z());
    const Flow along111 =
        flow(m, material::test::with_axis_along_z({1, 1, 1}), material::test::tension_z());
    if (!tests::on_root(MPI_COMM_WORLD)) continue;
    EXPECT_NEAR(along001.slip, 8 * 0.30619, 1e-4);  // eight systems
    EXPECT_NEAR(along111.slip, 6 * 0.61237, 1e-4);  // six
    EXPECT_LT(std::max(along001.spin.norm(), along111.spin.norm()), 1e-6);
  }
}

}  // namespace
}  // namespace polyslip::solver
