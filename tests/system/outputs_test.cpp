// What a run, a meshing and a conversion leave, by the names and columns of docs/results-format.md.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Outputs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    sandbox_ = std::make_unique<Sandbox>();
    run_deck(*sandbox_, 2, small_deck(), "run", {"--profile"});
  }
  static void TearDownTestSuite() { sandbox_.reset(); }
  static fs::path folder() { return sandbox_->path(); }
  static fs::path run() { return folder() / "run"; }
  static json summary() { return json::parse(slurp(run() / "summary.json")); }

  static std::unique_ptr<Sandbox> sandbox_;
};

std::unique_ptr<Sandbox> Outputs::sandbox_;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::vector<double>> numbers_of(const std::vector<std::string>& lines, char separator) {
  std::vector<std::vector<double>> table;
  for (const auto& line : lines) {
    std::istringstream cells(line);
    auto& row = table.emplace_back();
    for (std::string cell; std::getline(cells, cell, separator);) row.push_back(std::stod(cell));
  }
  return table;
}

/// Lines between $Name and $EndName of a mesh file, without their count.
std::vector<std::string> section(const fs::path& msh, const std::string& name) {
  const auto lines = lines_of(slurp(msh));
  const auto begin = std::find(lines.begin(), lines.end(), fmt::format("${}", name));
  const auto end = std::find(begin, lines.end(), fmt::format("$End{}", name));
  if (end - begin < 2) return {};
  return {begin + 2, end};
}

/// Grain of each tetrahedron of a mesh file: the physical volume. `type`: 11 quadratic, 4 linear.
std::vector<int> grains_of(const fs::path& msh, int type) {
  std::vector<int> grains;
  for (const auto& element : numbers_of(section(msh, "Elements"), ' '))
    if (element.at(1) == type) grains.push_back(static_cast<int>(element.at(3)));
  return grains;
}

TEST_F(Outputs, AreThereByTheirNames) {
  for (const auto* name :
       {"deck.toml", "deck.resolved.toml", "log.txt", "results.xdmf", "macro.csv", "mesh-000.msh",
        "mesh-001.msh", "polycrystal.tess", "summary.json", "polycrystal.png",
        "results/state-0000.h5", "results/state-0004.h5", "results/index.json"})
    EXPECT_GT(slurp(run() / name).size(), 50u) << name;
  EXPECT_FALSE(fs::exists(run() / "results/state-0005.h5"));
  EXPECT_FALSE(fs::exists(run() / "mesh-002.msh"));
  for (const auto& [name, content] : tree(run())) EXPECT_FALSE(name.ends_with(".part")) << name;
}

TEST_F(Outputs, DeckIsKeptAsGivenAndAsUnderstood) {
  EXPECT_EQ(slurp(run() / "deck.toml"), small_deck());
  const Outcome checked = run_polyslip({"check", "run/deck.resolved.toml"}, folder());
  EXPECT_EQ(checked.code, 0) << checked.err;
  const std::string resolved = slurp(run() / "deck.resolved.toml");
  for (const auto* key : {"progression_factor", "c11", "rate_sensitivity", "newton_tolerance"})
    EXPECT_NE(resolved.find(key), std::string::npos) << key;
}

TEST_F(Outputs, MacroCsvHasItsColumns) {
  const auto lines = lines_of(slurp(run() / "macro.csv"));
  ASSERT_GT(lines.size(), 10u);
  EXPECT_EQ(lines[0],
            "strain,time,step_size,sxx,syy,szz,syz,szx,sxy,fx_x1,fy_y1,fz_z1,newton_iterations,"
            "linear_iterations,remeshed,load_strain,load_stress,fx_x0,fy_x0,fz_x0,fy_x1,fz_x1,fx_"
            "y0,fy_y0,"
            "fz_y0,fx_y1,fz_y1,fx_z0,fy_z0,fz_z0,fx_z1,fy_z1");
  int remeshed = 0;
  double before = 0, last = 0;
  for (const MacroRow& row : read_macro(run())) {
    if (row.remeshed) before = last;
    remeshed += row.remeshed;
    last = row.strain;
  }
  EXPECT_EQ(remeshed, 1);
  EXPECT_EQ(before, 0.03);
  EXPECT_EQ(last, 0.06);
}

TEST_F(Outputs, MeshesAreGmshFilesOfQuadraticTetrahedraWithNamedFaces) {
  for (const auto* name : {"mesh-000.msh", "mesh-001.msh"}) {
    const std::string text = slurp(run() / name);
    EXPECT_EQ(text.rfind("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", 0), 0u) << name;
    for (const auto* face : {"x0", "x1", "y0", "y1", "z0", "z1"})
      EXPECT_NE(text.find(fmt::format("\"{}\"\n", face)), std::string::npos) << face;
    const auto grains = grains_of(run() / name, 11);
    ASSERT_GT(grains.size(), 8u);
    EXPECT_TRUE(std::is_sorted(grains.begin(), grains.end()));
    EXPECT_EQ(grains.front(), 1);
    EXPECT_EQ(grains.back(), 8);
  }
}

TEST_F(Outputs, SummaryHasItsFields) {
  const json s = summary();
  EXPECT_EQ(s.at("schema"), "polyslip-summary/1");
  EXPECT_EQ(s.at("completed"), json(true));
  EXPECT_EQ(s.at("final_strain"), json(0.06));
  EXPECT_EQ(s.at("grains"), json(8));
  EXPECT_EQ(s.at("seed"), json(1));
  EXPECT_EQ(s.at("elements_initial"), json(grains_of(run() / "mesh-000.msh", 11).size()));
  EXPECT_EQ(s.at("elements_final"), json(grains_of(run() / "mesh-001.msh", 11).size()));
  EXPECT_EQ(s.at("nodes_final"), json(section(run() / "mesh-001.msh", "Nodes").size()));
  for (const auto* count : {"step_cuts", "newton_iterations", "linear_iterations"})
    EXPECT_TRUE(s.at(count).is_number_unsigned()) << count;
  for (const auto* number : {"wall_s", "peak_rss_mb"}) {
    ASSERT_TRUE(s.at(number).is_number()) << number;
    EXPECT_GT(s[number].get<double>(), 0) << number;
  }
  EXPECT_FALSE(s.at("version").get<std::string>().empty());
}

TEST_F(Outputs, SummaryCountsTheRowsOfTheCurve) {
  const json s = summary();
  const auto rows = read_macro(run());
  EXPECT_EQ(s.at("steps"), json(rows.size()));
  long newton = 0, linear = 0;
  for (const MacroRow& row : rows) {
    newton += row.newton_iterations;
    linear += row.linear_iterations;
  }
  EXPECT_EQ(s.at("newton_iterations"), json(newton));
  EXPECT_EQ(s.at("linear_iterations"), json(linear));
  ASSERT_EQ(s.at("stress_final_mpa").size(), 3u);
  const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_EQ(s["stress_final_mpa"][i].at(j).get<double>(), rows.back().stress[place[i][j]]);
}

TEST_F(Outputs, SummaryTellsOfTheRemeshing) {
  const json s = summary();
  ASSERT_EQ(s.at("remeshings").size(), 1u);
  const json r = s["remeshings"][0];
  EXPECT_EQ(r.at("strain"), json(0.03));
  EXPECT_EQ(r.at("elements_before"), s.at("elements_initial"));
  EXPECT_EQ(r.at("elements_after"), s.at("elements_final"));
  for (const auto* ratio : {"min_radius_ratio_before", "min_radius_ratio_after"}) {
    EXPECT_GT(r.at(ratio).get<double>(), 0) << ratio;
    EXPECT_LT(r.at(ratio).get<double>(), 1) << ratio;
  }
  EXPECT_GE(r.at("max_grain_volume_change").get<double>(), 0);
  EXPECT_LT(r.at("max_grain_volume_change").get<double>(), 0.005);
  EXPECT_TRUE(r.at("strain_to_reload").is_number());
}

/// CPU seconds by stage: each stage took some, all together no more than both processors gave.
TEST_F(Outputs, SummaryTellsTheCpuTimeOfEachStage) {
  const json s = summary();
  double sum = 0;
  for (const auto* stage : {"polycrystal", "meshing", "deformation", "remeshing", "output"}) {
    ASSERT_TRUE(s.at("cpu_s").contains(stage)) << stage;
    const double seconds = s["cpu_s"][stage];
    EXPECT_GT(seconds, 0) << stage;
    sum += seconds;
  }
  EXPECT_GT(s["cpu_s"]["deformation"], s["cpu_s"]["polycrystal"]);
  EXPECT_GT(s["cpu_s"]["meshing"], s["cpu_s"]["polycrystal"]);
  EXPECT_LT(sum, 4 * s["wall_s"].get<double>());  // two ranks and, while meshing, workers
}

TEST_F(Outputs, ProfileTellsTheTimeOfTheSolversStages) {
  const std::string text = slurp(run() / "profile.txt");
  for (const char* stage : {"material", "smoother", "vertex level", "exchange of nodes"})
    EXPECT_NE(text.find(stage), std::string::npos) << stage << '\n' << text;
  EXPECT_NE(text.find("between the 2 ranks"), std::string::npos) << text;
  EXPECT_NE(slurp(run() / "profile-petsc.txt").find("smoother"), std::string::npos);
}

TEST_F(Outputs, PictureIsAPng) {
  const std::string png = slurp(run() / "polycrystal.png");
  ASSERT_GT(png.size(), 1000u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(12, 4), "IHDR");
  EXPECT_NE(png.find("IEND"), std::string::npos);
}

TEST_F(Outputs, TimeSeriesNamesEveryStoredState) {
  const std::string xdmf = slurp(run() / "results.xdmf");
  for (int i = 0; i < 5; ++i)
    EXPECT_NE(xdmf.find(fmt::format("results/state-000{}.h5", i)), std::string::npos) << i;
  EXPECT_NE(xdmf.find("CollectionType=\"Temporal\""), std::string::npos);
}

/// A row an element in the order of the mesh file; the state that was taken is named.
TEST_F(Outputs, ConvertWritesARowAnElement) {
  for (const std::string value : {"", "average", "centroid"}) {
    const std::string file = fmt::format("table-{}.csv", value);
    std::vector<std::string> arguments{"convert", "run", "--at-strain", "0.055", "--to", file};
    if (!value.empty()) arguments.insert(arguments.end(), {"--value", value});
    const Outcome outcome = run_polyslip(arguments, folder());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("strain 0.06"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("state-0004.h5"), std::string::npos) << outcome.out;
    auto lines = lines_of(slurp(folder() / file));
    ASSERT_GT(lines.size(), 1u);
    EXPECT_EQ(lines[0],
              "element,grain,x,y,z,volume,q0,q1,q2,q3,g,slip,equivalent_strain,sxx,syy,szz,syz,szx,"
              "sxy,pressure");
    lines.erase(lines.begin());
    const auto grains = grains_of(run() / "mesh-001.msh", 11);
    const auto table = numbers_of(lines, ',');
    ASSERT_EQ(table.size(), grains.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
      const auto& row = table[i];
      ASSERT_EQ(row.size(), 20u);
      EXPECT_EQ(row[0], static_cast<double>(i + 1));
      EXPECT_EQ(row[1], grains[i]);
      EXPECT_NEAR(std::hypot(std::hypot(row[6], row[7]), std::hypot(row[8], row[9])), 1, 1e-12);
      EXPECT_NEAR(row[19], -(row[13] + row[14] + row[15]) / 3, 1e-6);
      EXPECT_GT(row[10], 8);   // MPa: it has hardened
      EXPECT_LT(row[10], 12);  // MPa: not beyond saturation
      EXPECT_GT(row[12], 0);
    }
  }
  EXPECT_EQ(slurp(folder() / "table-.csv"), slurp(folder() / "table-average.csv"));
  EXPECT_NE(slurp(folder() / "table-average.csv"), slurp(folder() / "table-centroid.csv"));
}

/// Averages of elements, weighted by volume, are the averages of the curve.
TEST_F(Outputs, ConvertedStressesAverageToTheCurve) {
  const Outcome outcome =
      run_polyslip({"convert", "run", "--at-strain", "1", "--to", "end.csv"}, folder());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto lines = lines_of(slurp(folder() / "end.csv"));
  lines.erase(lines.begin());
  double volume = 0, stress[6] = {};
  for (const auto& row : numbers_of(lines, ',')) {
    volume += row.at(5);
    for (int c = 0; c < 6; ++c) stress[c] += row[5] * row.at(13 + c);
  }
  EXPECT_NEAR(volume, 8, 0.01);  // eight grains of unit mean volume
  const MacroRow last = read_macro(run()).back();
  for (int c = 0; c < 6; ++c)
    EXPECT_NEAR(stress[c] / volume, last.stress[c], 1e-6 * last.von_mises()) << c;
}

/// `polyslip mesh` makes the mesh that a run starts from, and says what applies to it.
TEST_F(Outputs, MeshVerbLeavesTheFirstMeshOfTheRun) {
  const Outcome outcome = run_polyslip({"mesh", "run.toml", "--out", "mesh"}, folder());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const fs::path made = folder() / "mesh";
  for (const auto* file : {"mesh-000.msh", "polycrystal.tess", "deck.toml", "deck.resolved.toml"})
    EXPECT_EQ(slurp(made / file), slurp(run() / file)) << file;
  const json s = json::parse(slurp(made / "summary.json"));
  EXPECT_EQ(s.at("schema"), "polyslip-summary/1");
  EXPECT_EQ(s.at("elements_initial"), summary().at("elements_initial"));
  EXPECT_EQ(s.at("grains"), json(8));
  EXPECT_GT(s.at("min_radius_ratio").get<double>(), 0);
  EXPECT_GT(s.at("mean_radius_ratio").get<double>(), s["min_radius_ratio"].get<double>());
  EXPECT_LT(s["mean_radius_ratio"].get<double>(), 1);
  EXPECT_GT(s.at("cpu_s").at("meshing").get<double>(), 0);
  for (const auto* absent : {"final_strain", "steps", "remeshings", "stress_final_mpa"})
    EXPECT_FALSE(s.contains(absent)) << absent;
}

TEST_F(Outputs, MeshVerbMakesLinearElementsIfAsked) {
  std::string deck = small_deck();
  deck.replace(deck.find("[mesh]\n"), 7, "[mesh]\norder = 1\n");
  sandbox_->write("linear.toml", deck);
  const Outcome outcome = run_polyslip({"mesh", "linear.toml", "--out", "linear"}, folder());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(grains_of(folder() / "linear/mesh-000.msh", 4), grains_of(run() / "mesh-000.msh", 11));
}

/// The last lines of a run: a summary, the paths of results, picture and report.
TEST_F(Outputs, LogEndsWithTheSummaryAndThePaths) {
  const auto lines = lines_of(slurp(run() / "log.txt"));
  ASSERT_GT(lines.size(), 10u);
  const auto n = lines.size();
  EXPECT_NE(lines[n - 4].find("summary: 8 grains"), std::string::npos) << lines[n - 4];
  EXPECT_NE(lines[n - 3].find("results: run/results.xdmf"), std::string::npos) << lines[n - 3];
  EXPECT_NE(lines[n - 2].find("picture: run/polycrystal.png"), std::string::npos) << lines[n - 2];
  EXPECT_NE(lines[n - 1].find("report: run/report.html"), std::string::npos) << lines[n - 1];
}

/// A run is never written over unless --overwrite says so; then nothing of the old one is left.
TEST_F(Outputs, OverwriteReplacesAnEarlierRun) {
  fs::copy(run(), folder() / "again", fs::copy_options::recursive);
  std::string deck = small_deck();
  deck.replace(deck.find("at_strains = [0.03]"), 19, "at_strains = []");
  deck.replace(deck.find("seed = 1"), 8, "seed = 2");
  sandbox_->write("other.toml", deck);
  const auto before = tree(folder());
  for (const std::string verb : {"run", "mesh"}) {
    const Outcome refused = run_polyslip({verb, "other.toml", "--out", "again"}, folder());
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("--overwrite"), std::string::npos) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_EQ(tree(folder()), before);
  }
  const Outcome outcome =
      run_polyslip({"run", "other.toml", "--out", "again", "--overwrite"}, folder());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(slurp(folder() / "again/deck.toml"), deck);
  EXPECT_FALSE(fs::exists(folder() / "again/mesh-001.msh"));
  EXPECT_EQ(state_count(folder() / "again"), 3u);
  EXPECT_NE(slurp(folder() / "again/mesh-000.msh"), slurp(run() / "mesh-000.msh"));
  EXPECT_EQ(json::parse(slurp(folder() / "again/summary.json")).at("seed"), json(2));
}

TEST(CommandLine, HelpAndVersion) {
  Sandbox sandbox;
  for (const std::string argument : {"--help", "--version"}) {
    const Outcome outcome = run_polyslip({argument}, sandbox.path());
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("polyslip"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
  }
}

}  // namespace
}  // namespace polyslip::tests
