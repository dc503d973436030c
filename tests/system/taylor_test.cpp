// `polyslip taylor`: the files it leaves, and the known answers of section 5 of the design:
// Taylor's factors (Taylor 1938, Bishop and Hill 1951 in the rate-independent limit: 3.0667
// and 2.8788), single crystals in closed form, and textures of a random polycrystal in plane
// strain.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/texture.hpp"
#include "material/point_driver.hpp"
#include "results/analysis/analysis.hpp"
#include "results/orientation_state.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;
using core::Quaternion;

const std::string plane_strain = "type = \"plane-strain-compression\"";
const std::string tension = "type = \"uniaxial-tension\"\naxis = \"z\"";

/// A deck without hardening; `more` goes into [taylor] and [orientations] tables.
std::string deck(double m, const std::string& loading, double strain, const std::string& more,
                 int grains = 8) {
  return fmt::format(
      "[polycrystal]\ngrains = {}\nseed = 3\n[material]\nrate_sensitivity = {}\nh0 = 0\n"
      "[loading]\n{}\nfinal_strain = {}\n{}\n",
      grains, m, loading, strain, more);
}

void write_orientations(const Sandbox& sandbox, const std::vector<Quaternion>& orientations) {
  std::string text;
  for (const auto& q : orientations)
    text += fmt::format("{} {} {} {}\n", q.w(), q.x(), q.y(), q.z());
  sandbox.write("orientations.txt", text);
}

const std::string from_file =
    "[orientations]\ndistribution = \"file\"\nfile = \"orientations.txt\"\n";

void run_taylor(const Sandbox& sandbox, const std::string& text, const std::string& folder,
                int ranks = 0) {
  sandbox.write("deck.toml", text);
  const auto outcome = run_program(
      on_ranks(ranks, {"taylor", "deck.toml", "--out", folder, "--threads", "1"}), sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
}

nlohmann::json summary_of(const Sandbox& sandbox, const std::string& folder) {
  return nlohmann::json::parse(slurp(sandbox.path() / folder / "summary.json"));
}

struct Row {
  double m, tension, plane_strain, tolerance;
};

TEST(Taylor, FactorsOfARandomPolycrystal) {
  Sandbox sandbox;
  write_orientations(sandbox, material::spread_orientations(5000));
  // The table has three decimals, so half of the last beside its tolerance.
  const Row rows[] = {{1.0, 1.65, 1.65, 1e-3},      {0.2, 2.767, 2.681, 1.5e-3},
                      {0.12, 2.881, 2.756, 4e-3},   {0.1, 2.910, 2.774, 1.5e-3},
                      {0.05, 2.986, 2.824, 1.5e-3}, {0.02, 3.034, 2.856, 1.5e-3},
                      {0.01, 3.050, 2.867, 1.5e-3}};
  int number = 0;
  for (const auto& row : rows)
    for (const auto& [load, expected] :
         {std::pair{tension, row.tension}, std::pair{plane_strain, row.plane_strain}}) {
      const std::string folder = fmt::format("taylor-{}", number++);
      run_taylor(sandbox, deck(row.m, load, 2e-4, from_file, 5000), folder);
      const double factor = summary_of(sandbox, folder)["taylor"]["initial_stress_over_g"];
      EXPECT_NEAR(factor, expected, row.tolerance) << row.m << ' ' << load;
      std::printf("m = %.2f: %.4f (%.3f)\n", row.m, factor, expected);
    }
}

struct Crystal {
  const char* name;
  core::Vec3 plane, direction;
  double limit, at_012;  ///< sum of |slip| per strain eps33
};

// Plane strain: the rate-independent limits are good to four digits at m = 0.02. In {001}<100> and
// {011}<100> rolled along <100> four systems or more share the slip. S: the largest work over the
// 56 stress states of Bishop and Hill, and the minimum of the power law's potential at m = 0.12.
TEST(Taylor, SlipOfSingleCrystals) {
  const double root = std::sqrt(6.0);
  const Crystal crystals[] = {{"cube", {0, 0, 1}, {1, 0, 0}, root, 2.4571},
                              {"goss", {0, 1, 1}, {1, 0, 0}, root, root},
                              {"brass", {0, 1, 1}, {2, -1, 1}, 4 * root / 3, 3.2739},
                              {"copper", {1, 1, 2}, {-1, -1, 1}, 3 * root / 2, 3.6831},
                              {"S", {1, 2, 3}, {6, 3, -4}, 3.4864, 3.4866},
                              {"D", {4, 4, 11}, {11, 11, -8}, 3.530, 3.5367},
                              {"{011}<01-1>", {0, 1, 1}, {0, 1, -1}, 2 * root, 2 * root}};
  for (const Crystal& crystal : crystals)
    for (const double m : {0.02, 0.12}) {
      Sandbox sandbox;
      write_orientations(sandbox, {core::miller_orientation(crystal.plane, crystal.direction)});
      run_taylor(sandbox, deck(m, plane_strain, 1e-4, from_file, 1), "taylor");
      const double per_mises = summary_of(sandbox, "taylor")["taylor"]["initial_slip_per_strain"];
      EXPECT_NEAR(per_mises * 2 / std::numbers::sqrt3, m < 0.1 ? crystal.limit : crystal.at_012,
                  6e-4)
          << crystal.name << ' ' << m;
    }
}

TEST(Taylor, LeavesTheFilesOfARun) {
  Sandbox sandbox;
  run_taylor(sandbox,
             deck(0.12, plane_strain, 0.1,
                  "[taylor]\norientations = 101\n[output]\nat_strains = [0.04]\n"),
             "taylor");
  const auto rows = read_macro(sandbox.path() / "taylor");
  ASSERT_GT(rows.size(), 5u);
  EXPECT_DOUBLE_EQ(rows.back().strain, 0.1);
  EXPECT_DOUBLE_EQ(rows.back().stress[0], 0);  // the free direction
  EXPECT_LT(rows.back().stress[2], -15);
  const auto summary = summary_of(sandbox, "taylor");
  EXPECT_EQ(summary["completed"], true);
  EXPECT_EQ(summary["grains"], 101);
  EXPECT_EQ(summary["steps"], rows.size());
  EXPECT_EQ(state_count(sandbox.path() / "taylor"), 3u);
  EXPECT_FALSE(fs::exists(sandbox.path() / "taylor" / "results.xdmf"));

  const auto converted = run_polyslip(
      {"convert", "taylor", "--at-strain", "0.1", "--to", "table.csv"}, sandbox.path());
  ASSERT_EQ(converted.code, 0) << converted.err;
  EXPECT_EQ(line_count(sandbox.path() / "table.csv"), 102);
  const auto state = results::read_orientation_state(
      (sandbox.path() / "taylor" / "results" / "state-0002.h5").string());
  EXPECT_DOUBLE_EQ(state.strain, 0.1);
  core::Vec6 mean = core::Vec6::Zero();
  for (const auto& s : state.table.cauchy_stress) mean += s / 101;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(mean[i], rows.back().stress[i], 1e-9);
}

TEST(Taylor, IsTheSameOnEveryNumberOfRanks) {
  Sandbox sandbox;
  const std::string text = deck(0.12, tension, 0.05, "[taylor]\norientations = 30\n");
  run_taylor(sandbox, text, "one");
  const auto one =
      results::read_orientation_state((sandbox.path() / "one/results/state-0001.h5").string());
  for (const int ranks : {2, 3}) {
    const std::string folder = fmt::format("on-{}", ranks);
    run_taylor(sandbox, text, folder, ranks);
    const auto other = results::read_orientation_state(
        (sandbox.path() / folder / "results/state-0001.h5").string());
    ASSERT_EQ(other.table.orientation.size(), 30u);
    for (std::size_t i = 0; i < 30; ++i) {
      EXPECT_EQ(other.table.orientation[i].coeffs(), one.table.orientation[i].coeffs());
      EXPECT_EQ(other.table.slip[i], one.table.slip[i]);
    }
  }
}

TEST(Taylor, RefusesWhatItCannotDo) {
  Sandbox sandbox;
  sandbox.write("faces.toml",
                "[loading]\ntype = \"faces\"\nx0 = \"sliding\"\ny0 = \"sliding\"\nz0 = "
                "\"sliding\"\nz1 = \"sliding\"\n"
                "z1_velocity = [0, 0, -1]\n");
  expect_rejection(
      sandbox, {"taylor", "faces.toml"},
      "faces.toml:2:8: [loading] type = \"faces\" gives no velocity gradient; Taylor's "
      "model needs another type");
  run_taylor(sandbox, deck(0.12, tension, 0.01, ""), "taylor");
  sandbox.write("deck.toml", deck(0.12, tension, 0.01, ""));
  const auto again = run_polyslip({"taylor", "deck.toml", "--out", "taylor"}, sandbox.path());
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("holds the results of an earlier run"), std::string::npos) << again.err;
  expect_rejection(
      sandbox, {"run", "--restart", "taylor"},
      "taylor: holds a Taylor model, which is not restarted; run polyslip taylor again "
      "with --overwrite");
}

/// Intensities of the texture that N random orientations take, against the table of 80,000, within
/// 3 % or three standard errors of the sampling. The kernel's estimate of f from N orientations has
/// the variance f mean(K^2) / (24 N variants); mean(K^2)/24 is 23 at a half-width of 10 degrees.
void expect_taylor_textures(int count, const std::vector<double>& strains, int ranks) {
  const std::map<std::string, std::vector<double>> table{
      {"copper", {3.25, 5.36, 6.70, 8.40}}, {"dillamore", {4.74, 8.19, 10.28, 12.90}},
      {"s", {2.93, 4.29, 4.94, 5.40}},      {"brass", {2.80, 3.41, 3.48, 3.22}},
      {"goss", {1.67, 1.56, 1.38, 1.09}},   {"cube", {0.87, 0.66, 0.49, 0.31}}};
  Sandbox sandbox;
  run_taylor(sandbox,
             deck(0.05, plane_strain, strains.back(),
                  fmt::format("[taylor]\norientations = {}\n[output]\nat_strains = [{}]\n", count,
                              fmt::join(strains, ", "))),
             "taylor", ranks);
  results::analysis::AnalysisOptions options;
  options.at_strains = strains;
  const auto analysis =
      results::analysis::analyse_folder((sandbox.path() / "taylor").string(), options);
  ASSERT_EQ(analysis.textures.size(), strains.size());
  for (std::size_t i = 0; i < strains.size(); ++i)
    for (const auto& c : analysis.textures[i].components) {
      if (!table.contains(c.name)) continue;
      const double expected = table.at(c.name)[i];
      double variants = 1;
      for (const auto& component : results::analysis::rolling_components())
        if (component.name == c.name) variants = static_cast<double>(component.variants.size());
      const double error = std::sqrt(expected * 23 / (count * variants));
      EXPECT_NEAR(c.intensity, expected, std::max(0.03 * expected, 3 * error))
          << c.name << " at " << strains[i];
      std::printf("%.1f %-10s %7.3f (%.2f, standard error %.3f)\n", strains[i], c.name.c_str(),
                  c.intensity, expected, error);
    }
}

TEST(Taylor, TextureOfAFewOrientations) { expect_taylor_textures(3000, {0.5}, 0); }

TEST(TaylorSlow, TexturesOfFiftyThousandOrientations) {
  expect_taylor_textures(50000, {0.5, 1.0, 1.4, 2.0}, 2);
}

}  // namespace
}  // namespace polyslip::tests
