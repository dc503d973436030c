// `polyslip analyse`, `compare` and the exports of a run and its Taylor model; docs/python too.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/random.hpp"
#include "core/rotation.hpp"
#include "results/analysis/analysis.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;
namespace ra = results::analysis;

/// A run, its Taylor model and the analyses of both, made once.
struct Made {
  Sandbox sandbox;
  fs::path run, taylor;
  Outcome analyse_run, analyse_taylor, compare;
};

const Made& made() {
  static const Made* const all = [] {
    auto* m = new Made;
    m->run = m->sandbox.path() / "run";
    m->taylor = m->sandbox.path() / "taylor";
    run_deck(m->sandbox, 0, small_deck(), "run");
    m->sandbox.write("taylor.toml", small_deck());
    const auto taylor =
        run_polyslip({"taylor", "taylor.toml", "--out", "taylor"}, m->sandbox.path());
    EXPECT_EQ(taylor.code, 0) << taylor.err;
    m->analyse_run = run_polyslip({"analyse", "run"}, m->sandbox.path());
    m->analyse_taylor = run_polyslip({"analyse", "taylor"}, m->sandbox.path());
    m->compare = run_polyslip({"compare", "run", "taylor"}, m->sandbox.path());
    return m;
  }();
  return *all;
}

/// Rows of a CSV file by column.
std::vector<std::map<std::string, std::string>> table(const fs::path& path) {
  std::ifstream in(path);
  std::string line, word;
  std::getline(in, line);
  std::vector<std::string> header;
  for (std::istringstream words(line); std::getline(words, word, ',');) header.push_back(word);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; std::getline(words, word, ','); ++i) row[header.at(i)] = word;
    EXPECT_EQ(row.size(), header.size()) << line;
    rows.push_back(row);
  }
  return rows;
}

TEST(Analysis, LeavesTablesAndFigures) {
  const Made& m = made();
  ASSERT_EQ(m.analyse_run.code, 0) << m.analyse_run.err;
  ASSERT_EQ(m.analyse_taylor.code, 0) << m.analyse_taylor.err;
  const auto texture = table(m.run / "texture.csv");
  ASSERT_FALSE(texture.empty());
  EXPECT_EQ(slurp(m.run / "texture.csv").substr(0, 42),
            "strain,component,intensity,volume_fraction");
  // Of the two states at the remeshing one counts.
  EXPECT_EQ(texture.size(), 7 * (state_count(m.run) - 1));
  for (const auto& row : texture) {
    EXPECT_GE(std::stod(row.at("intensity")), 0);
    EXPECT_LE(std::stod(row.at("volume_fraction")), 1);
  }
  for (const auto& row : table(m.run / "analysis" / "texture-index.csv"))
    EXPECT_NEAR(std::stod(row.at("mean")), 1, 1e-3);
  for (const char* name :
       {"components.svg", "beta-fibre.csv", "pole-figures-0.06.svg", "pole-figures-0.06.csv",
        "inverse-pole-figures-0.06.svg", "odf-bunge-0.06.csv", "odf-rodrigues-0.06.svg",
        "spread-distribution.svg", "spread-correlation.svg", "rotation-paths.svg", "analysis.json"})
    EXPECT_GT(fs::file_size(m.run / "analysis" / name), 500u) << name;
  EXPECT_FALSE(fs::exists(m.taylor / "spreads.csv"));
}

TEST(Analysis, SpreadsAreThoseOfTheElements) {
  const Made& m = made();
  const auto rows = table(m.run / "spreads.csv");
  EXPECT_EQ(rows.size(), 8 * (state_count(m.run) - 1));
  double before = -1;
  for (const auto& row : rows) {
    const double strain = std::stod(row.at("strain")), spread = std::stod(row.at("spread"));
    const bool deformed = strain > 0;
    EXPECT_EQ(spread > (deformed ? 0.01 : 1e-6), deformed) << strain << ' ' << spread;
    EXPECT_LE(spread, std::stod(row.at("largest")) + 1e-12);
    if (row.at("grain") != "1") continue;
    EXPECT_GT(spread, before);  // it grows
    before = spread;
  }
}

TEST(Analysis, IsNotWrittenOverUnlessAsked) {
  const Made& m = made();
  const auto again = run_polyslip({"analyse", "run"}, m.sandbox.path());
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("holds an earlier analysis"), std::string::npos) << again.err;
  const auto compared = run_polyslip({"compare", "run", "taylor"}, m.sandbox.path());
  EXPECT_EQ(compared.code, 2);
  EXPECT_NE(compared.err.find("is an earlier comparison"), std::string::npos) << compared.err;
}

TEST(Analysis, ComparesARunWithItsTaylorModel) {
  const Made& m = made();
  ASSERT_EQ(m.compare.code, 0) << m.compare.err;
  const auto rows = table(m.run / "analysis" / "compare.csv");
  std::map<std::string, double> mine, theirs;
  for (const auto& row : rows)
    if (std::stod(row.at("strain")) == 0) {
      // The same orientations, but grains by volume.
      EXPECT_NEAR(std::stod(row.at("intensity_run")), std::stod(row.at("intensity_taylor")),
                  0.8 * (1 + std::stod(row.at("intensity_taylor"))));
    }
  EXPECT_GE(rows.size(), 14u);
  for (const char* name : {"compare-components.svg", "compare-beta-fibre.svg", "compare-stress.svg",
                           "compare-pole-figures.svg", "compare-odf-rodrigues.svg"})
    EXPECT_GT(fs::file_size(m.run / "analysis" / name), 500u) << name;
}

// What MTEX and Neper are given makes the same densities as the run.
TEST(Analysis, ExportsReproduceTheDensities) {
  const Made& m = made();
  for (const auto& [folder, format, file] :
       {std::tuple{"run", "mtex", "run.txt"}, std::tuple{"taylor", "mtex", "taylor.txt"},
        std::tuple{"taylor", "ori", "taylor.ori"}}) {
    const auto converted =
        run_polyslip({"convert", folder, "--at-strain", "0.06", "--to", file, "--format", format},
                     m.sandbox.path());
    ASSERT_EQ(converted.code, 0) << converted.err;
    const std::string to = std::string(file) + "-analysis";
    const auto analysed = run_polyslip({"analyse", file, "--to", to}, m.sandbox.path());
    ASSERT_EQ(analysed.code, 0) << analysed.err;
    const auto original = table(m.sandbox.path() / folder / "analysis" / "odf-rodrigues-0.06.csv");
    const auto read = table(m.sandbox.path() / to / "analysis" / "odf-rodrigues-0.csv");
    ASSERT_EQ(original.size(), read.size());
    ASSERT_GT(read.size(), 10000u);
    double largest = 0, error = 0;
    for (std::size_t i = 0; i < read.size(); ++i) {
      const double f = std::stod(original[i].at("density"));
      largest = std::max(largest, f);
      error = std::max(error, std::abs(std::stod(read[i].at("density")) - f));
    }
    EXPECT_GT(largest, 2);
    // Angles are rounded in their last digits, so orientations at a cell's edge may change cells.
    EXPECT_LT(error, 1e-3 * largest) << file;
  }
}

TEST(Analysis, TheTutorialsFigureAgrees) {
  const Made& m = made();
  const auto outcome =
      run_program({"/usr/bin/python3", POLYSLIP_SOURCE_DIR "/docs/python/spreads.py",
                   m.run.string(), (m.sandbox.path() / "python.csv").string()},
                  m.sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto ours = table(m.run / "spreads.csv"), theirs = table(m.sandbox.path() / "python.csv");
  ASSERT_EQ(ours.size(), theirs.size());
  ASSERT_FALSE(ours.empty());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].at("grain"), theirs[i].at("grain"));
    EXPECT_NEAR(std::stod(ours[i].at("spread")), std::stod(theirs[i].at("spread")), 1e-4);
  }
}

TEST(Analysis, RefusesWhatItCannotRead) {
  Sandbox sandbox;
  expect_rejection(sandbox, {"analyse", "nothing"}, "nothing: no such file or folder");
  sandbox.write("empty.txt", "# no orientations\n");
  expect_rejection(sandbox, {"analyse", "empty.txt"},
                   "empty.txt: holds no orientation with a weight");
  sandbox.write("wrong.txt", "1 0 0 0\n1 0 0\n");
  expect_rejection(sandbox, {"analyse", "wrong.txt"},
                   "wrong.txt:2: 3 numbers, must be 4 (quaternion: w x y z), and a weight in all "
                   "lines or none");
  sandbox.write("folder/notes.txt", "");
  expect_rejection(sandbox, {"analyse", "folder"},
                   "folder: holds no stored state; give the folder of a run that has begun, or a "
                   "file of orientations");
  expect_rejection(sandbox, {"analyse", "wrong.txt", "--inner"},
                   "wrong.txt: a file of orientations has no grains or strains; leave --inner, "
                   "--one-mode, --at-strains and --grains out");
}

}  // namespace
}  // namespace polyslip::tests
