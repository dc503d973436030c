// What must not change the answer: a rigid rotation, a restart, the number of ranks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/rotation.hpp"
#include "solver/model.hpp"
#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

using mesh::Location;

SolverOptions tight() {
  SolverOptions o;
  o.newton_tolerance = 1e-9;
  o.linear_tolerance = 1e-6;
  return o;
}

LoadingOptions loading() {
  LoadingOptions l;
  l.max_strain_increment = 0.01;
  l.initial_strain_increment = 1e-3;
  return l;
}

const std::vector<double>& values(const mesh::Snapshot& s, const std::string& name, Location at) {
  const auto* f = s.find(name, at);
  EXPECT_NE(f, nullptr) << name;
  EXPECT_FALSE(f->values.empty()) << name;
  return f->values;
}

core::Mat3 tensor(const double* s) {
  core::Mat3 t;
  t << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return t;
}

double degrees_between(const double* a, const double* b) {
  const core::Quaternion p(a[0], a[1], a[2], a[3]), q(b[0], b[1], b[2], b[3]);
  return core::degrees_per_radian * core::rotation_angle(p * q.conjugate());
}

TEST(Consistency, ASuperposedRigidRotationOnlyTurnsTheFrame) {
  const auto law = material::make_fcc_law({});
  const core::Vec3 axis = core::Vec3(0.3, -0.5, 0.8).normalized();
  const auto rotation = [&](double s) { return core::exp_axial(10 * s * axis).toRotationMatrix(); };
  const auto stretch = [](double s) -> core::Mat3 {
    core::Mat3 f;
    f << std::exp(s), 0.2 * s, 0, 0, 1, 0.1 * s, 0, 0, std::exp(-s);
    return f;
  };
  const auto run = [&](bool turned) {
    Boundary b;
    b.mean_gradient = [=](double s) -> core::Mat3 {
      return turned ? core::Mat3(rotation(s) * stretch(s)) : stretch(s);
    };
    b.all = [f = b.mean_gradient](const core::Vec3& x, double s) -> core::Vec3 { return f(s) * x; };
    Model model(MPI_COMM_WORLD, tests::slab_box(MPI_COMM_WORLD, *law), *law, b, loading(), tight(),
                {});
    while (model.strain() < 0.03) model.step(0.03);
    return model.snapshot();
  };
  const auto plain = run(false), turned = run(true);
  if (!tests::on_root(MPI_COMM_WORLD)) return;
  const core::Mat3 R = rotation(0.03);
  const auto &s0 = values(plain, "cauchy_stress", Location::quadrature_point),
             &s1 = values(turned, "cauchy_stress", Location::quadrature_point);
  const auto &q0 = values(plain, "orientation", Location::quadrature_point),
             &q1 = values(turned, "orientation", Location::quadrature_point);
  ASSERT_EQ(s0.size(), s1.size());
  double largest = 0;
  for (std::size_t i = 0; i < s0.size() / 6; ++i) {
    const core::Mat3 back = R.transpose() * tensor(&s1[6 * i]) * R;
    ASSERT_LT((back - tensor(&s0[6 * i])).norm(), 1e-5) << i;
    largest = std::max(largest, back.norm());
    const core::Quaternion q = core::Quaternion(R) * core::Quaternion(q0[4 * i], q0[4 * i + 1],
                                                                      q0[4 * i + 2], q0[4 * i + 3]);
    const double expected[4] = {q.w(), q.x(), q.y(), q.z()};
    ASSERT_LT(degrees_between(expected, &q1[4 * i]), 1e-5) << i;
  }
  EXPECT_GT(largest, 10);
}

/// Both elements with each quadrature rule, or some of them.
struct Element {
  const char* name;
  int points;
};

class EachElement : public ::testing::TestWithParam<Element> {
 protected:
  SolverOptions with_element(SolverOptions options) const {
    options.element = GetParam().name;
    options.quadrature_points = GetParam().points;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, EachElement,
                         ::testing::Values(Element{"mixed", 4}, Element{"mixed", 8},
                                           Element{"displacement", 14},
                                           Element{"displacement", 15}));

TEST_P(EachElement, ARestartContinuesBitForBit) {
  const auto law = material::make_fcc_law({});
  const SolverOptions options = with_element({});
  Model first(
      MPI_COMM_WORLD,
      tests::slab_box(MPI_COMM_WORLD, *law, core::Quaternion::Identity(), GetParam().points), *law,
      loading(), options, {});
  for (int i = 0; i < 5; ++i) first.step(0.1);
  first.drop_setup();
  const mesh::Snapshot checkpoint = first.snapshot();
  Model second(MPI_COMM_WORLD, checkpoint, *law, loading(), options, {});
  EXPECT_EQ(first.strain(), second.strain());
  EXPECT_EQ(first.time(), second.time());
  for (int i = 0; i < 4; ++i) {
    const StepRecord a = first.step(0.1), b = second.step(0.1);
    EXPECT_EQ(a.strain, b.strain);
    EXPECT_EQ(a.stress, b.stress);
    EXPECT_EQ(a.linear_iterations, b.linear_iterations);
    EXPECT_GT(b.newton_iterations, 0);
  }
  const mesh::Snapshot a = first.snapshot(), b = second.snapshot();
  EXPECT_EQ(a.history, b.history);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (const auto& f : a.fields) {
    const auto& other = values(b, f.name, f.location);
    ASSERT_EQ(f.values.size(), other.size()) << f.name;
    EXPECT_EQ(std::memcmp(f.values.data(), other.data(), f.values.size() * sizeof(double)), 0)
        << f.name;
  }
  for (std::size_t n = 0; n < a.mesh.nodes.size(); ++n) ASSERT_EQ(a.mesh.nodes[n], b.mesh.nodes[n]);
}

/// The stored states of a run, at strains 0.01 and 0.03.
std::vector<mesh::Snapshot> run_on(MPI_Comm comm, const SolverOptions& options,
                                   std::vector<StepRecord>& records) {
  const auto law = material::make_fcc_law({});
  LoadingOptions l = loading();
  l.fixed_increment = true;
  std::vector<mesh::Snapshot> out;
  Model model(comm,
              tests::slab_box(comm, *law, core::Quaternion::Identity(), options.quadrature_points),
              *law, l, options, {});
  for (double target : {0.01, 0.03}) {
    while (model.strain() < target) records.push_back(model.step(target));
    out.push_back(model.snapshot());
  }
  return out;
}

TEST_P(EachElement, TheNumberOfRanksDoesNotMatter) {
  std::vector<StepRecord> together, alone;
  const auto many = run_on(MPI_COMM_WORLD, with_element(tight()), together);
  const auto one = run_on(MPI_COMM_SELF, with_element(tight()), alone);
  ASSERT_EQ(together.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i)
    for (std::size_t c = 0; c < 6; ++c)
      EXPECT_NEAR(together[i].stress[c], alone[i].stress[c], 1e-6 * std::abs(alone[i].stress[2]));
  if (!tests::on_root(MPI_COMM_WORLD)) return;
  for (std::size_t k = 0; k < one.size(); ++k) {
    const auto &s0 = values(one[k], "cauchy_stress", Location::quadrature_point),
               &s1 = values(many[k], "cauchy_stress", Location::quadrature_point);
    double largest = 0, error = 0;
    for (std::size_t i = 0; i < s0.size(); ++i) {
      largest = std::max(largest, std::abs(s0[i]));
      error = std::max(error, std::abs(s0[i] - s1[i]));
    }
    EXPECT_GT(largest, 10);
    EXPECT_LT(error, 1e-6 * largest);
    const auto &q0 = values(one[k], "orientation", Location::quadrature_point),
               &q1 = values(many[k], "orientation", Location::quadrature_point);
    for (std::size_t i = 0; i < q0.size(); i += 4) ASSERT_LT(degrees_between(&q0[i], &q1[i]), 1e-4);
  }
}

TEST(Consistency, AtDefaultTolerancesTheCurveAgreesAndTheForcesBalance) {
  std::vector<StepRecord> together, alone;
  run_on(MPI_COMM_WORLD, SolverOptions{}, together);
  run_on(MPI_COMM_SELF, SolverOptions{}, alone);
  ASSERT_EQ(together.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const double flow = std::abs(alone[i].stress[2]);
    for (std::size_t c = 0; c < 6; ++c)
      EXPECT_NEAR(together[i].stress[c], alone[i].stress[c], 2e-3 * flow);
    EXPECT_LT(std::abs(alone[i].stress[0]), 1e-2 * flow);
    EXPECT_NEAR(alone[i].fz_z1, -alone[i].face_forces[4][2], 1e-3 * std::abs(alone[i].fz_z1));
    EXPECT_NEAR(alone[i].fy_y1, -alone[i].face_forces[2][1], 1e-3 * std::abs(alone[i].fz_z1));
    EXPECT_NEAR(alone[i].fx_x1, 0, 1e-3 * std::abs(alone[i].fz_z1));
    EXPECT_NEAR(alone[i].face_forces[0][0], 0, 1e-3 * std::abs(alone[i].fz_z1));
  }
}

}  // namespace
}  // namespace polyslip::solver
