// What an analysis takes from stored states.

#include "results/analysis/run_sample.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.hpp"
#include "results/analysis/analysis.hpp"
#include "results/analysis/compare.hpp"
#include "results/element_values.hpp"
#include "unit/results/fabricated.hpp"

namespace polyslip {
namespace {

namespace ra = results::analysis;

/// A folder with states at these strains.
void fill(const std::string& folder, const std::vector<double>& strains) {
  std::filesystem::create_directories(folder + "/results");
  results::StateSeries series(folder);
  for (const double strain : strains) series.store(tests::fabricated_snapshot(1, strain));
}

std::vector<std::string> names(const std::vector<results::StateRecord>& states) {
  std::vector<std::string> list;
  for (const auto& s : states) list.push_back(s.file);
  return list;
}

using Names = std::vector<std::string>;

TEST(ChosenStates, AreOneAStrain) {
  const tests::TemporaryFolder folder;
  fill(folder / "run", {0, 0.3, 0.3, 0.6});
  const results::StateSeries series(folder / "run");
  EXPECT_EQ(names(ra::chosen_states(series, {})),
            (Names{"state-0000.h5", "state-0001.h5", "state-0003.h5"}));
  EXPECT_EQ(names(ra::chosen_states(series, {0.601, 0.3, 0.299})),
            (Names{"state-0001.h5", "state-0003.h5"}));
  EXPECT_THROW(ra::chosen_states(series, {0.4}), core::InputError);
  fill(folder / "empty", {});
  EXPECT_THROW(ra::chosen_states(results::StateSeries(folder / "empty"), {}), core::InputError);
}

TEST(RunSample, HoldsElementsVolumesAndGrains) {
  const tests::TemporaryFolder folder;
  fill(folder / "run", {0.2});
  const auto snapshot = tests::fabricated_snapshot(1, 0.2);
  const auto table = results::element_values(snapshot, results::ElementValue::average);
  const auto s = ra::read_run_sample(folder / "run/results/state-0000.h5");
  EXPECT_TRUE(s.meshed);
  EXPECT_EQ(s.strain, 0.2);
  EXPECT_EQ(s.sample.weights, table.volume);
  EXPECT_EQ(s.grain, snapshot.mesh.tetrahedron_cell);
  EXPECT_EQ(s.grains(), 2);
  EXPECT_EQ(s.inner, (std::vector<bool>{false, false}));
  for (std::size_t i = 0; i < s.sample.size(); ++i)
    EXPECT_LT((s.sample.orientations[i].coeffs() - table.orientation[i].coeffs()).norm(), 1e-14);
  EXPECT_EQ(ra::of_grains(s, {true, false}).size() + ra::of_grains(s, {false, true}).size(),
            s.sample.size());
  EXPECT_THROW(ra::of_grains(s, {false, false}), core::InternalError);
}

TEST(Analysis, InnerGrainsHaveToBeThere) {
  const tests::TemporaryFolder folder;
  fill(folder / "run", {0.2});
  ra::AnalysisOptions options;
  options.inner = true;
  EXPECT_THROW(ra::analyse_folder(folder / "run", options), core::InputError);
}

TEST(Compare, StrainsOfBoth) {
  const tests::TemporaryFolder folder;
  fill(folder / "run", {0, 0.3, 0.3, 0.6});
  fill(folder / "other", {0, 0.30005, 0.5});
  EXPECT_EQ(ra::common_strains(folder / "run", folder / "other", {}),
            (std::vector<double>{0, 0.3}));
  EXPECT_EQ(ra::common_strains(folder / "run", folder / "other", {0.3}),
            (std::vector<double>{0.3}));
  EXPECT_THROW(ra::common_strains(folder / "run", folder / "other", {0.6}), core::InputError);
}

}  // namespace
}  // namespace polyslip
