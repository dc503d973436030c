#include <omp.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <tuple>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "random_points.hpp"
#include "reference_update.hpp"

namespace {

using namespace polyslip;
using material::MaterialOptions;
using material::PointStatus;
using material::test::Batch;
using material::test::ReferencePoint;

core::Random stream(std::uint64_t seed) { return {seed, core::Stream::tests}; }

struct Hardening {
  std::string name;
  double g0, gs, h0, voce_exponent, latent_ratio;
};
std::ostream& operator<<(std::ostream& stream, const Hardening& h) { return stream << h.name; }

/// Of the paper; with steep and blunt Voce factors; strengths of their own, weaker and stronger
/// latent hardening than self-hardening.
const Hardening paper{"paper", 8, 12, 4, 1, 1}, steep{"steep", 8, 24, 40, 2.25, 1},
    blunt{"blunt", 8, 24, 40, 0.5, 1}, latent{"latent", 8, 24, 40, 1, 1.4},
    weak_latent{"weak_latent", 8, 12, 4, 1, 0.3}, latent_steep{"latent_steep", 8, 24, 20, 1.6, 1.8};

using Case = std::tuple<double, Hardening>;  // m

class Update : public ::testing::TestWithParam<Case> {
 protected:
  MaterialOptions options_ = [] {
    const auto& [m, h] = GetParam();
    MaterialOptions o;
    o.rate_sensitivity = m;
    o.g0 = h.g0;
    o.gs = h.gs;
    o.h0 = h.h0;
    o.voce_exponent = h.voce_exponent;
    o.latent_ratio = h.latent_ratio;
    return o;
  }();
  std::unique_ptr<material::CrystalLaw> law_ = material::make_fcc_law(options_);
};

TEST_P(Update, AgreesWithThePlainTwin) {
  Batch batch(*law_, 100);
  auto random = stream(11);
  material::test::randomise(batch, *law_, options_, random, 1e-5, 0.08);
  batch.run(*law_);
  ASSERT_EQ(batch.failures(), 0);
  const material::test::ReferenceUpdate reference(options_);
  const double stiffest = std::max(options_.c11 - options_.c12, 2 * options_.c44);
  int compared = 0;
  for (int p = 0; p < batch.points; ++p) {
    ReferencePoint old;
    old.orientation = core::Quaternion(batch.old_state(p, 0), batch.old_state(p, 1),
                                       batch.old_state(p, 2), batch.old_state(p, 3));
    core::Vec5 start;
    for (int i = 0; i < 5; ++i) {
      old.elastic[i] = batch.old_state(p, 4 + i);
      // near the solution, but not on it: the twin has no good start of its own
      start[i] =
          batch.new_state(p, 4 + i) * (1 + 0.01 * random.normal() * options_.rate_sensitivity);
    }
    material::test::Strengths start_g(batch.strengths);
    old.g.resize(batch.strengths);
    for (int a = 0; a < batch.strengths; ++a) {
      old.g[a] = batch.old_state(p, batch.strength + a);
      const double g = batch.new_state(p, batch.strength + a);
      start_g[a] = g + 0.01 * random.uniform() * options_.rate_sensitivity * (options_.gs - g);
    }
    const ReferencePoint twin =
        reference.update(old, batch.gradient_of(p), batch.time_step, start, start_g);
    if (!twin.converged) continue;
    ++compared;
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(batch.new_state(p, 4 + i), twin.elastic[i], 1e-8 * 20 / stiffest) << p;
    }
    for (int a = 0; a < batch.strengths; ++a) {
      EXPECT_NEAR(batch.new_state(p, batch.strength + a), twin.g[a], 2e-8) << p << " " << a;
    }
    EXPECT_NEAR(batch.new_state(p, batch.slip), twin.slip, 1e-10) << p;
    EXPECT_NEAR(batch.new_state(p, batch.equivalent_strain), twin.equivalent_strain, 1e-10) << p;
    EXPECT_LT((batch.stress_of(p) - twin.stress).norm(), 1e-7) << p;
    EXPECT_LT((batch.orientation_of(p).coeffs() - twin.orientation.coeffs()).norm(), 1e-10) << p;
  }
  EXPECT_GE(compared, 95);
}

TEST_P(Update, TangentIsTheDerivativeOfTheStress) {
  Batch batch(*law_, 240);
  auto random = stream(12);
  material::test::randomise(batch, *law_, options_, random, 1e-6, 0.08);
  batch.run(*law_);
  ASSERT_EQ(batch.failures(), 0);
  double worst = 0;
  for (int kl = 0; kl < 9; ++kl) {
    // Richardson's combination of two central differences; the step is small against the elastic
    // strain at yield times m, over which the stress curves
    const double h = 2e-6 * std::min(options_.rate_sensitivity, 0.1);
    std::vector<Batch> at;
    for (const double factor : {1.0, -1.0, 2.0, -2.0}) {
      at.push_back(batch);
      for (int p = 0; p < batch.points; ++p) {
        core::Mat3 one = core::Mat3::Identity();
        one(kl / 3, kl % 3) += factor * h;
        at.back().set_gradient(p, one * batch.gradient_of(p));
      }
      at.back().run(*law_, false);
      ASSERT_EQ(at.back().failures(), 0);
    }
    for (int p = 0; p < batch.points; ++p) {
      double size = 0;
      for (int i = 0; i < 54; ++i) {
        size = std::max(size, std::abs(batch.tangent[material::test::lane_index(p, i, 54)]));
      }
      const core::Vec6 difference = (8 * (at[0].stress_of(p) - at[1].stress_of(p)) -
                                     (at[2].stress_of(p) - at[3].stress_of(p))) /
                                    (12 * h);
      for (int i = 0; i < 6; ++i) {
        const double exact = batch.tangent[material::test::lane_index(p, 9 * i + kl, 54)];
        worst = std::max(worst, std::abs(exact - difference[i]) / size);
        EXPECT_NEAR(exact, difference[i], 1e-6 * size)
            << "point " << p << " entry " << i << " " << kl;
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(worst, 0.0);
}

TEST_P(Update, ARigidRotationTurnsStressAndLatticeAndNothingElse) {
  Batch batch(*law_, 100);
  auto random = stream(13);
  material::test::randomise(batch, *law_, options_, random, 1e-4, 0.05);
  Batch turned = batch;
  std::vector<core::Quaternion> turns;
  for (int p = 0; p < batch.points; ++p) {
    turns.push_back(random.rotation());
    turned.set_gradient(p, core::to_matrix(turns.back()) * batch.gradient_of(p));
  }
  batch.run(*law_);
  turned.run(*law_);
  ASSERT_EQ(batch.failures() + turned.failures(), 0);
  for (int p = 0; p < batch.points; ++p) {
    const core::Mat3 q = core::to_matrix(turns[static_cast<std::size_t>(p)]);
    const core::Mat3 expected = q * core::from_mandel(batch.stress_of(p)) * q.transpose();
    EXPECT_LT((turned.stress_of(p) - core::mandel(expected)).norm(), 1e-9);
    const core::Quaternion lattice = turns[static_cast<std::size_t>(p)] * batch.orientation_of(p);
    EXPECT_LT(core::rotation_angle(turned.orientation_of(p) * lattice.conjugate()), 1e-7);
    for (int i = 4; i < batch.components; ++i) {
      EXPECT_NEAR(turned.new_state(p, i), batch.new_state(p, i),
                  1e-11 * std::max(1.0, std::abs(batch.new_state(p, i))));
    }
  }
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  return std::get<1>(info.param).name + "_" +
         std::to_string(static_cast<int>(100 * std::get<0>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(Sensitivities, Update,
                         ::testing::Combine(::testing::Values(0.12, 0.05, 0.02, 0.3),
                                            ::testing::Values(paper, latent)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Hardening, Update,
                         ::testing::Combine(::testing::Values(0.12),
                                            ::testing::Values(steep, blunt, weak_latent,
                                                              latent_steep)),
                         name_of);

TEST(UpdateOptions, NoHardeningKeepsTheStrength) {
  for (const auto& [gs, h0, q] :
       {std::tuple{8.0, 4.0, 1.0}, std::tuple{12.0, 0.0, 1.0}, std::tuple{8.0, 4.0, 1.4}}) {
    MaterialOptions o;
    o.voce_exponent = 2;
    o.latent_ratio = q;
    o.gs = gs;
    o.h0 = h0;
    const auto law = material::make_fcc_law(o);
    Batch batch(*law, 40);
    auto random = stream(14);
    material::test::randomise(batch, *law, o, random, 1e-3, 0.05);
    batch.run(*law);
    ASSERT_EQ(batch.failures(), 0);
    for (int p = 0; p < batch.points; ++p) {
      for (int a = batch.strength; a < batch.slip; ++a) {
        EXPECT_EQ(batch.new_state(p, a), batch.old_state(p, a));
      }
      EXPECT_GT(batch.new_state(p, batch.slip), 0.0);
    }
  }
}

TEST(UpdateOptions, TwelveEqualStrengthsAreOne) {
  // with q = 1 + 1e-9 the twelve strengths of equal start stay equal, and are the one of q = 1
  MaterialOptions one;
  one.voce_exponent = 1.5;
  MaterialOptions twelve = one;
  twelve.latent_ratio = 1 + 1e-9;
  const auto law = material::make_fcc_law(one), laws = material::make_fcc_law(twelve);
  Batch batch(*law, 40), batches(*laws, 40);
  auto random = stream(19);
  material::test::randomise(batch, *law, one, random, 1e-4, 0.05);
  for (int p = 0; p < batch.points; ++p) {
    batches.set_gradient(p, batch.gradient_of(p));
    for (int i = 0; i < batch.strength; ++i) batches.old_state(p, i) = batch.old_state(p, i);
    for (int a = 0; a < 12; ++a) {
      batches.old_state(p, batches.strength + a) = batch.old_state(p, batch.strength);
    }
  }
  batch.run(*law);
  batches.run(*laws);
  ASSERT_EQ(batch.failures() + batches.failures(), 0);
  for (int p = 0; p < batch.points; ++p) {
    for (int a = 0; a < 12; ++a) {
      EXPECT_NEAR(batches.new_state(p, batches.strength + a), batch.new_state(p, batch.strength),
                  1e-8);
    }
    EXPECT_LT((batches.stress_of(p) - batch.stress_of(p)).norm(), 1e-6);
    for (int i = 0; i < 54; ++i) {
      EXPECT_NEAR(batches.tangent[material::test::lane_index(p, i, 54)],
                  batch.tangent[material::test::lane_index(p, i, 54)], 1e-2);
    }
  }
}

TEST(UpdateOptions, VolumeChangeAloneLeavesNoStress) {
  const auto law = material::make_fcc_law({});
  Batch batch(*law, 4);
  for (int p = 0; p < 4; ++p) batch.set_gradient(p, 1.01 * core::Mat3::Identity());
  batch.run(*law);
  ASSERT_EQ(batch.failures(), 0);
  for (int p = 0; p < 4; ++p) EXPECT_LT(batch.stress_of(p).norm(), 1e-9);
}

TEST(UpdateOptions, AnElasticStepHasCubicElasticity) {
  const MaterialOptions o;
  const auto law = material::make_fcc_law(o);
  Batch batch(*law, 4);
  batch.time_step = 1e-9;
  core::Mat3 f = core::Mat3::Identity();
  f(0, 0) = std::exp(1e-6);
  f(1, 1) = std::exp(-1e-6);
  batch.set_gradient(0, f);
  f = core::Mat3::Identity();
  f(0, 1) = f(1, 0) = 1e-6;
  batch.set_gradient(1, f);
  batch.run(*law);
  ASSERT_EQ(batch.failures(), 0);
  EXPECT_NEAR(batch.stress_of(0)[0], (o.c11 - o.c12) * 1e-6, 1e-9);
  EXPECT_NEAR(batch.stress_of(0)[1], -(o.c11 - o.c12) * 1e-6, 1e-9);
  EXPECT_NEAR(batch.stress_of(1)[5], std::sqrt(2.0) * 2 * o.c44 * 1e-6, 1e-9);
}

TEST(UpdateStatus, BadInputIsToldApartAndHurtsNoNeighbour) {
  const MaterialOptions o;
  const auto law = material::make_fcc_law(o);
  Batch good(*law, 8);
  auto random = stream(15);
  material::test::randomise(good, *law, o, random, 1e-3, 0.05);
  Batch bad = good;
  good.run(*law);
  core::Mat3 f = bad.gradient_of(1);
  f(1, 2) = std::nan("");
  bad.set_gradient(1, f);
  f = core::Mat3::Identity();
  f(2, 2) = -1;
  bad.set_gradient(2, f);
  bad.old_state(5, 9) = std::numeric_limits<double>::infinity();
  bad.old_state(7, 5) = std::nan("");
  bad.run(*law);
  const PointStatus expected[8] = {PointStatus::converged,     PointStatus::not_finite,
                                   PointStatus::not_converged, PointStatus::converged,
                                   PointStatus::converged,     PointStatus::not_finite,
                                   PointStatus::converged,     PointStatus::not_finite};
  for (int p = 0; p < 8; ++p) {
    EXPECT_EQ(bad.status[static_cast<std::size_t>(p)], expected[p]) << p;
    if (expected[p] != PointStatus::converged) continue;
    EXPECT_EQ(bad.stress_of(p), good.stress_of(p)) << p;
    for (int i = 0; i < 12; ++i) EXPECT_EQ(bad.new_state(p, i), good.new_state(p, i)) << p;
  }
}

class UpdateOrder : public ::testing::TestWithParam<double> {};  // latent ratio

TEST_P(UpdateOrder, ResultsDependNeitherOnThreadsNorOnNeighbours) {
  MaterialOptions o;
  o.latent_ratio = GetParam();
  o.voce_exponent = GetParam();
  const auto law = material::make_fcc_law(o);
  Batch batch(*law, 64);
  auto random = stream(16);
  material::test::randomise(batch, *law, o, random, 1e-5, 0.08);
  Batch shuffled(*law, 64);
  const auto place = [](int p) { return (p * 37 + 5) % 64; };
  for (int p = 0; p < 64; ++p) {
    shuffled.set_gradient(place(p), batch.gradient_of(p));
    for (int i = 0; i < batch.components; ++i) {
      shuffled.old_state(place(p), i) = batch.old_state(p, i);
    }
  }
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  batch.run(*law);
  omp_set_num_threads(3);
  shuffled.run(*law);
  omp_set_num_threads(threads);
  ASSERT_EQ(batch.failures(), 0);
  for (int p = 0; p < 64; ++p) {
    for (int i = 0; i < batch.components; ++i) {
      EXPECT_EQ(shuffled.new_state(place(p), i), batch.new_state(p, i)) << p << " " << i;
    }
    for (int i = 0; i < 54; ++i) {
      EXPECT_EQ(shuffled.tangent[material::test::lane_index(place(p), i, 54)],
                batch.tangent[material::test::lane_index(p, i, 54)]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Latent, UpdateOrder, ::testing::Values(1.0, 1.4));

TEST(Options, EachBoundIsChecked) {
  const auto rejects = [](auto change, const std::string& word) {
    MaterialOptions o;
    change(o);
    try {
      material::make_fcc_law(o);
      ADD_FAILURE() << word;
    } catch (const core::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  rejects([](auto& o) { o.c11 = 1; }, "c11");
  rejects([](auto& o) { o.c12 = -0.9 * o.c11; }, "c12");
  rejects([](auto& o) { o.c44 = 0; }, "c44");
  rejects([](auto& o) { o.reference_slip_rate = std::nan(""); }, "reference_slip_rate");
  rejects([](auto& o) { o.rate_sensitivity = 0; }, "rate_sensitivity");
  rejects([](auto& o) { o.g0 = -1; }, "g0");
  rejects([](auto& o) { o.gs = 7; }, "gs");
  rejects([](auto& o) { o.h0 = -1; }, "h0");
  rejects([](auto& o) { o.voce_exponent = 0; }, "voce_exponent");
  rejects([](auto& o) { o.latent_ratio = -0.1; }, "latent_ratio");
}

}  // namespace
