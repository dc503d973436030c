// A polycrystal to large strain with no hand on it: the deck of inputs/plane-strain-large.toml with
// fewer grains, to a strain of 1.4.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/rotation.hpp"
#include "mesh/mesh.hpp"
#include "remap/grain_statistics.hpp"
#include "remap/transport.hpp"
#include "results/state_file.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

void put(std::string& deck, const std::string& old, const std::string& fresh) {
  const auto at = deck.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  deck.replace(at, old.size(), fresh);
}

std::string large_deck(int grains) {
  std::string deck = slurp(std::string(POLYSLIP_SOURCE_DIR) + "/inputs/plane-strain-large.toml");
  put(deck, "grains = 100", fmt::format("grains = {}", grains));
  put(deck, "final_strain = 2.5", "final_strain = 1.4");
  put(deck, "at_strains = [0.5, 1.0, 1.5, 2.0]", "at_strains = [0.5, 1.0]");
  return deck;
}

/// Pairs of states, before and after each remeshing.
std::vector<std::array<mesh::Snapshot, 2>> remeshings_of(const std::filesystem::path& run) {
  const results::StateSeries series(run.string());
  const auto& states = series.states();
  std::vector<std::array<mesh::Snapshot, 2>> pairs;
  for (std::size_t i = 1; i < states.size(); ++i)
    if (states[i].mesh_number != states[i - 1].mesh_number)
      pairs.push_back({results::read_state(series.path(states[i - 1])),
                       results::read_state(series.path(states[i]))});
  return pairs;
}

struct VolumeChange {
  double worst = 0, rms = 0, total = 0;
};

VolumeChange volume_change(const std::vector<double>& before, const std::vector<double>& after) {
  VolumeChange change;
  double sum_before = 0, sum_after = 0;
  for (std::size_t g = 0; g < before.size(); ++g) {
    const double d = after[g] / before[g] - 1;
    change.worst = std::max(change.worst, std::abs(d));
    change.rms += d * d / static_cast<double>(before.size());
    sum_before += before[g];
    sum_after += after[g];
  }
  change.rms = std::sqrt(change.rms);
  change.total = std::abs(sum_after / sum_before - 1);
  return change;
}

double volume_at_zero_pressure(const mesh::Snapshot& s) {
  double sum = 0;
  for (const auto& g : remap::grain_statistics(s)) sum += g.volume_at_zero_pressure;
  return sum;
}

/// Limits of the project: every mesh passes check(); in a remeshing at most 1 % of the faces are
/// copied and grain volumes change by no more than 0.3 %, 0.1 % rms; accumulated over all of them
/// no grain's volume is off by more than 0.7 %, 0.2 % rms, the whole by 0.05 %. From the start to
/// the end the same under load (pressure compresses the whole by 0.02 %), and at zero pressure a
/// tenth of it, most of which is quadrature: four points an element.
TEST(LargeStrain, SlowRemeshesItselfToAStrainOf1p4) {
  const Sandbox sandbox;
  run_deck(sandbox, 1, large_deck(30), "run");
  ASSERT_FALSE(HasFailure());
  const auto run = sandbox.path() / "run";
  const auto first = state_of(run, 0), last = last_state(run);
  EXPECT_NEAR(last.strain, 1.4, 1e-9);
  EXPECT_EQ(first.mesh.topology.cell_count(), 30);
  for (std::size_t i = 0; i < state_count(run); ++i)
    ASSERT_NO_THROW(mesh::check(state_of(run, i).mesh)) << "state " << i;
  const auto pairs = remeshings_of(run);
  ASSERT_GE(pairs.size(), 2u);
  auto accumulated = mesh::grain_volumes(first.mesh);
  const auto start = accumulated;
  for (const auto& [before, after] : pairs) {
    const auto from = mesh::grain_volumes(before.mesh), to = mesh::grain_volumes(after.mesh);
    for (std::size_t g = 0; g < from.size(); ++g) accumulated[g] *= to[g] / from[g];
    const VolumeChange change = volume_change(from, to);
    EXPECT_LT(change.worst, 3e-3) << before.strain;
    EXPECT_LT(change.rms, 1e-3) << before.strain;
  }
  const VolumeChange remeshed = volume_change(start, accumulated);
  const VolumeChange all = volume_change(start, mesh::grain_volumes(last.mesh));
  for (const auto& change : {remeshed, all}) {
    EXPECT_LT(change.worst, 7e-3);
    EXPECT_LT(change.rms, 2e-3);
  }
  EXPECT_LT(remeshed.total, 5e-4);
  EXPECT_LT(all.total, 5e-4);
  EXPECT_NEAR(volume_at_zero_pressure(last) / volume_at_zero_pressure(first), 1, 5e-5);
  const auto summary = nlohmann::json::parse(slurp(run / "summary.json"));
  EXPECT_TRUE(summary.at("completed").get<bool>());
  const auto& remeshings = summary.at("remeshings");
  ASSERT_EQ(remeshings.size(), pairs.size());
  const double first_worst = mesh::quality(first.mesh).min_radius_ratio;
  for (const auto& r : remeshings) {
    EXPECT_LE(r.at("copied_faces").get<std::size_t>(), last.mesh.topology.faces.size() / 100);
    EXPECT_GE(r.at("min_radius_ratio_after").get<double>(), first_worst / 2);
  }
}

struct Carried {
  double rotation = 0;  ///< of grains' mean orientations, mean over grains and remeshings, degrees
  double spread = 0;    ///< relative change of its mean over the grains, the same mean
};

/// What an option of transport does to the states before a run's remeshings.
Carried carried(const std::vector<std::array<mesh::Snapshot, 2>>& pairs, const char* option) {
  Carried mean;
  for (const auto& [old, fresh] : pairs) {
    const auto before = remap::grain_statistics(old);
    const auto after =
        remap::grain_statistics(remap::transport(old, fresh.mesh, {option, "zero"}, 1));
    double from = 0, to = 0, rotation = 0;
    for (std::size_t g = 0; g < before.size(); ++g) {
      rotation += before[g].orientation.angularDistance(after[g].orientation);
      from += before[g].spread;
      to += after[g].spread;
    }
    mean.rotation +=
        rotation * core::degrees_per_radian / static_cast<double>(before.size() * pairs.size());
    mean.spread += (to / from - 1) / static_cast<double>(pairs.size());
  }
  return mean;
}

/// Remeshed every 0.2, with about `elements_a_grain` in the mean. The limits of 0-order are 0.3
/// degrees a remeshing at 100 elements a grain and 0.1 at 400, which "point" keeps. The paper's
/// "element" turns grains by 1.7 times as much or more and is only bounded here; the default,
/// "corrected", does not turn them. Why: docs/remeshing-accuracy.md, What transport alone does.
void expect_transport_to_keep_grains(double element_size, double elements_a_grain, double limit) {
  constexpr int grains = 16;
  std::string deck = large_deck(grains);
  put(deck, "element_size = 0.5 ", fmt::format("element_size = {} ", element_size));
  put(deck, "[remeshing]", "[remeshing]\nat_strains = [0.2, 0.4, 0.6, 0.8, 1.0, 1.2]");
  const Sandbox sandbox;
  run_deck(sandbox, 0, deck, "run");
  ASSERT_FALSE(::testing::Test::HasFailure());
  const auto pairs = remeshings_of(sandbox.path() / "run");
  ASSERT_GE(pairs.size(), 6u);
  double elements = 0;
  for (const auto& [old, fresh] : pairs)
    elements += old.mesh.element_count() / static_cast<double>(grains * pairs.size());
  EXPECT_NEAR(elements / elements_a_grain, 1, 0.15);
  const Carried element = carried(pairs, "element"), point = carried(pairs, "point");
  const Carried corrected = carried(pairs, "corrected");
  EXPECT_LT(point.rotation, limit);
  EXPECT_LT(element.rotation, 2 * limit);
  EXPECT_GT(point.rotation, limit / 10);
  EXPECT_LT(corrected.rotation, point.rotation / 3);
  EXPECT_LT(corrected.rotation, 1e-3);
  EXPECT_LT(element.spread, -0.03);
  EXPECT_LT(std::abs(point.spread), 0.01);
  EXPECT_LE(std::abs(corrected.spread), std::abs(point.spread));
}

TEST(LargeStrain, SlowTransportAloneHardlyTurnsGrainsOfAHundredElements) {
  expect_transport_to_keep_grains(0.55, 108, 0.3);
}
TEST(LargeStrain, SlowTransportAloneHardlyTurnsGrainsOfFourHundredElements) {
  expect_transport_to_keep_grains(0.32, 420, 0.1);
}

}  // namespace
}  // namespace polyslip::tests
