// Backward Euler's order in the step: stress and orientation at strain 0.12 of a few grains.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/rotation.hpp"
#include "solver/model.hpp"
#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

struct Result {
  double stress = 0;                // zz of the volume average, MPa
  std::vector<double> orientation;  // [elements][4][4]
};

Result run(const char* element, double step) {
  const auto law = material::make_fcc_law({});
  LoadingOptions loading;
  loading.max_strain_increment = step;
  loading.fixed_increment = true;
  SolverOptions options;
  options.element = element;
  options.newton_tolerance = 1e-7;
  options.linear_tolerance = 1e-4;
  Model model(MPI_COMM_SELF, tests::slab_box(MPI_COMM_SELF, *law), *law, loading, options, {});
  Result result;
  while (model.strain() < 0.12) result.stress = model.step(0.12).stress[2];
  const mesh::Snapshot s = model.snapshot();
  result.orientation = s.find("orientation", mesh::Location::quadrature_point)->values;
  return result;
}

/// Root mean square of the angles between the points' orientations, degrees.
double angle(const Result& a, const Result& b) {
  double sum = 0;
  const std::size_t n = a.orientation.size() / 4;
  for (std::size_t i = 0; i < n; ++i) {
    const auto quaternion = [&](const Result& r) {
      const double* q = &r.orientation[4 * i];
      return core::Quaternion(q[0], q[1], q[2], q[3]);
    };
    sum += std::pow(core::rotation_angle(quaternion(a) * quaternion(b).conjugate()), 2);
  }
  return core::degrees_per_radian * std::sqrt(sum / static_cast<double>(n));
}

void expect_first_order(const char* element, double step) {
  const Result coarse = run(element, step), fine = run(element, step / 2),
               finer = run(element, step / 4);
  const double stress = (coarse.stress - fine.stress) / (fine.stress - finer.stress);
  const double orientation = angle(coarse, fine) / angle(fine, finer);
  // An error c h differs by c h/2 between the steps h and h/2.
  const double scale = 0.01 / (step / 4);
  fmt::print(
      "{}, steps of {} and less: stress {:.5f}, {:.5f}, {:.5f} MPa, error {:+.3f} % per "
      "0.01; orientation {:.4f} degrees per 0.01; orders {:.2f}, {:.2f}\n",
      element, step, coarse.stress, fine.stress, finer.stress,
      100 * (fine.stress - finer.stress) / finer.stress * scale, angle(fine, finer) * scale,
      std::log2(stress), std::log2(orientation));
  EXPECT_NEAR(std::log2(stress), 1, 0.25);
  EXPECT_NEAR(std::log2(orientation), 1, 0.25);
}

TEST(StepSize, ErrorsOfTheMixedElementAreOfFirstOrder) { expect_first_order("mixed", 0.01); }
TEST(StepSize, ErrorsOfTheDisplacementElementAreOfFirstOrder) {
  expect_first_order("displacement", 0.01);
}

}  // namespace
}  // namespace polyslip::solver
