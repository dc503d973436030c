// The same run on 1, 2 and 3 ranks, and restarted on another number of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rotation.hpp"
#include "results/names.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

constexpr double degree = M_PI / 180;

/// Largest angle between the orientations at the quadrature points of two states, in degrees.
double largest_rotation(const mesh::Snapshot& a, const mesh::Snapshot& b) {
  const auto* p = a.find("orientation", mesh::Location::quadrature_point);
  const auto* q = b.find("orientation", mesh::Location::quadrature_point);
  if (!p || !q || p->values.empty() || p->values.size() != q->values.size()) return NAN;
  double largest = 0;
  for (std::size_t i = 0; i < p->values.size(); i += 4) {
    const Eigen::Map<const Eigen::Vector4d> u(&p->values[i]), v(&q->values[i]);
    const double sine = std::min((u - v).norm(), (u + v).norm()) / 2;
    largest = std::max(largest, 4 * std::asin(std::min(1.0, sine)));
    if (!std::isfinite(sine)) return NAN;
  }
  return largest / degree;
}

/// Largest difference of a stress component up to the first remeshing, relative to the flow stress.
double largest_difference(const std::vector<MacroRow>& a, const std::vector<MacroRow>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size() && !a[i].remeshed; ++i) {
    if (i >= b.size() || a[i].strain != b[i].strain) return NAN;
    for (int c = 0; c < 6; ++c) {
      const double relative = std::abs(a[i].stress[c] - b[i].stress[c]) / a[i].von_mises();
      if (!std::isfinite(relative)) return NAN;
      largest = std::max(largest, relative);
    }
  }
  return a.empty() ? NAN : largest;
}

/// Largest distance of two curves, interpolated in strain, relative to the flow stress, at the
/// strains of both. Below `from` of each loading from zero stress the steep rise is left out, where
/// the distance is one of step sizes.
double distance_of_curves(const std::vector<MacroRow>& a, const std::vector<MacroRow>& b) {
  double largest = 0;
  for (const auto* rows : {&a, &b})
    for (const MacroRow& row : *rows) {
      const double relative = std::abs(stress_at(a, row.strain) - stress_at(b, row.strain)) /
                              stress_at(a, a.back().strain);
      if (!std::isfinite(relative)) return NAN;
      largest = std::max(largest, relative);
    }
  return a.empty() || b.empty() ? NAN : largest;
}

void expect_agreement_by_rounding(const fs::path& one, const fs::path& other) {
  EXPECT_LT(largest_difference(read_macro(one), read_macro(other)), 1e-6);
  constexpr std::size_t before_remeshing = 2;  // start, 0.02, 0.03
  EXPECT_EQ(state_of(one, before_remeshing).strain, 0.03);
  EXPECT_EQ(state_of(one, before_remeshing).mesh_number, 0);
  EXPECT_LT(largest_rotation(state_of(one, before_remeshing), state_of(other, before_remeshing)),
            1e-4);
  EXPECT_LT(distance_of_curves(read_macro(one), read_macro(other)), 2e-3);
}

/// Runs on `ranks`, killed after the first checkpoint, then restarted on `later` ranks.
void run_restarted(const Sandbox& sandbox, int ranks, int later, const std::string& deck,
                   const std::string& folder) {
  sandbox.write(folder + ".toml", deck);
  Program program(on_ranks(ranks, {"run", folder + ".toml", "--out", folder}), sandbox.path());
  const fs::path checkpoint = sandbox.path() / folder / "checkpoints" / results::checkpoint_name(1);
  ASSERT_TRUE(eventually(120, [&] { return fs::exists(checkpoint) || program.ended(); }));
  program.kill({});
  program.wait();
  const Outcome outcome =
      run_program(on_ranks(later, {"run", "--restart", folder}), sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("going on from strain"), std::string::npos) << outcome.out;
}

/// The first mesh is the same file; with tight tolerances stress agrees to 1e-6 and orientation to
/// 1e-4 degrees up to the first remeshing, and the curves to 0.2 % throughout.
TEST(Ranks, AgreeByRoundingWithTightTolerances) {
  Sandbox sandbox;
  for (const int ranks : {1, 2, 3})
    run_deck(sandbox, ranks, tight_deck(), "ranks" + std::to_string(ranks));
  ASSERT_FALSE(HasFailure());
  const fs::path one = sandbox.path() / "ranks1";
  ASSERT_GT(slurp(one / "mesh-000.msh").size(), 1000u);
  for (const auto* other : {"ranks2", "ranks3"}) {
    SCOPED_TRACE(other);
    EXPECT_EQ(slurp(one / "mesh-000.msh"), slurp(sandbox.path() / other / "mesh-000.msh"));
    expect_agreement_by_rounding(one, sandbox.path() / other);
  }
}

TEST(Ranks, OfARestartAgreeLikewise) {
  Sandbox sandbox;
  run_deck(sandbox, 1, tight_deck(), "one");
  run_restarted(sandbox, 3, 2, tight_deck(), "three-two");
  run_restarted(sandbox, 1, 3, tight_deck(), "one-three");
  ASSERT_FALSE(HasFailure());
  for (const auto* other : {"three-two", "one-three"}) {
    SCOPED_TRACE(other);
    expect_agreement_by_rounding(sandbox.path() / "one", sandbox.path() / other);
  }
}

/// The macroscopic curve to 0.2 % of the flow stress through the remeshing, at default tolerances
/// and with steps that each run chooses.
TEST(Ranks, AgreeOnTheCurveAtDefaultTolerances) {
  Sandbox sandbox;
  for (const int ranks : {1, 2, 3})
    run_deck(sandbox, ranks, small_deck(), "ranks" + std::to_string(ranks));
  run_restarted(sandbox, 2, 1, small_deck(), "two-one");
  ASSERT_FALSE(HasFailure());
  const auto one = read_macro(sandbox.path() / "ranks1");
  for (const auto* other : {"ranks2", "ranks3", "two-one"}) {
    SCOPED_TRACE(other);
    EXPECT_LT(distance_of_curves(one, read_macro(sandbox.path() / other)), 2e-3);
  }
}

}  // namespace
}  // namespace polyslip::tests
