#include "results/statistics_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::results {
namespace {

using core::Vec3;

mesh::Tessellation cubes() {
  std::vector<Vec3> seeds;
  for (int i = 0; i < 27; ++i) seeds.emplace_back(i / 9 + 0.5, i / 3 % 3 + 0.5, i % 3 + 0.5);
  return mesh::voronoi_tessellation(seeds, Vec3::Constant(3));
}

long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(Statistics, CountsAllOrInnerGrains) {
  const auto measures = mesh::measure(cubes());
  const Statistics all = statistics_of(measures, nullptr, {});
  EXPECT_EQ(all.grains, 27);
  EXPECT_EQ(all.inner_grains, 1);
  EXPECT_EQ(all.vertices, 64);
  EXPECT_EQ(all.elements, 0);
  EXPECT_EQ(all.quantity("grain_faces").distribution.count, 27);
  EXPECT_EQ(all.quantity("grain_faces").distribution.mean, 6);
  EXPECT_EQ(all.quantity("grain_faces").histogram.counts.at(6), 27);
  EXPECT_NEAR(all.quantity("grain_relative_diameter").distribution.mean, 1, 1e-12);
  EXPECT_NEAR(all.quantity("grain_sphericity").distribution.mean, 0.806, 1e-3);
  EXPECT_EQ(all.quantity("edge_length").distribution.count, 144);
  EXPECT_THROW(all.quantity("radius_ratio"), core::InternalError);

  StatisticsOptions options;
  options.inner = true;
  const Statistics inner = statistics_of(measures, nullptr, options);
  EXPECT_EQ(inner.quantity("grain_faces").distribution.count, 1);
  EXPECT_EQ(inner.quantity("grain_neighbours").distribution.mean, 6);
  EXPECT_EQ(inner.quantity("face_diameter").distribution.count, 6);
  EXPECT_EQ(inner.quantity("edge_length").distribution.count, 12);
}

TEST(Statistics, RefusesInnerGrainsWhereThereAreNone) {
  const auto mesh = tests::box_mesh({2, 1, 1}, {2, 1, 1}, 2);
  StatisticsOptions options;
  options.inner = true;
  EXPECT_THROW(statistics_of(mesh::measure(mesh), &mesh, options), core::InputError);
}

TEST(Statistics, OfElementsNameTheSizeAskedFor) {
  const auto mesh = tests::box_mesh({2, 1, 1}, {2, 1, 1}, 2);
  const Statistics s = statistics_of(mesh::measure(mesh), &mesh, {});
  const double size = (3 + 2 * std::sqrt(2.0) + std::sqrt(3.0)) / 6;
  EXPECT_EQ(s.elements, 12);
  EXPECT_EQ(s.options.element_size_source, ElementSizeSource::mean);
  EXPECT_NEAR(*s.options.element_size, size, 1e-6);
  EXPECT_NEAR(s.O_size, 1, 1e-5);
  StatisticsOptions options;
  options.element_size = 2 * size;
  options.element_size_source = ElementSizeSource::option;
  const Statistics t = statistics_of(mesh::measure(mesh), &mesh, options);
  EXPECT_NEAR(t.quantity("relative_element_size").distribution.mean, 0.5, 1e-6);
  EXPECT_NEAR(t.O_size, 0.125, 1e-6);
  EXPECT_NEAR(t.quantity("grain_O_size").distribution.mean, 0.125, 1e-6);
  EXPECT_EQ(t.quantity("grain_elements").distribution.mean, 6);
  EXPECT_EQ(t.quantity("radius_ratio").counts_below.back().second, 0);
}

TEST(Statistics, SpoiltElementsAreCountedAsUndefined) {
  auto mesh = tests::box_mesh({2, 1, 1}, {2, 1, 1}, 2);
  mesh.nodes[mesh.tetrahedra[0][0]].x() = std::nan("");
  const Statistics s = statistics_of(mesh::measure(mesh), &mesh, {});
  EXPECT_GT(s.quantity("radius_ratio").distribution.undefined, 0);
  EXPECT_EQ(s.O, 0);
}

TEST(StatisticsFiles, AreTablesPlotsAndJson) {
  const tests::TemporaryFolder folder;
  const auto mesh = tests::box_mesh({4, 2, 2}, {4, 2, 2}, 2);
  const Statistics s = statistics_of(mesh::measure(mesh), &mesh, {});
  const auto names = write_statistics(folder / "out", s, &mesh, "box.msh");
  EXPECT_EQ(names.size(), 9U);
  for (const auto& name : names)
    EXPECT_GT(tests::slurp(folder / "out/" + name).size(), 60u) << name;
  EXPECT_EQ(lines(tests::slurp(folder / "out/grains.csv")), 3);
  EXPECT_EQ(lines(tests::slurp(folder / "out/faces.csv")), 1 + s.faces);
  EXPECT_EQ(lines(tests::slurp(folder / "out/edges.csv")), 1 + s.edges);
  EXPECT_EQ(lines(tests::slurp(folder / "out/elements.csv")), 1 + s.elements);
  const auto json = nlohmann::json::parse(tests::slurp(folder / "out/stats.json"));
  EXPECT_EQ(json["schema"], "polyslip-stats/1");
  EXPECT_EQ(json["quantities"]["grain_faces"]["mean"], 6.0);
  EXPECT_EQ(json["quantities"]["grain_volume"]["percentiles"]["50"].get<double>(),
            s.quantity("grain_volume").distribution.percentile(50));
  EXPECT_EQ(json["elements"], s.elements);
}

TEST(StatisticsFiles, SayWhatTheRegularisationDidToVolumes) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "run");
  EXPECT_FALSE(read_regularisation(folder / "run"));
  write_regularisation({.deletions = 7,
                        .short_before = 9,
                        .short_after = 2,
                        .max_flatness_fault = 19.5,
                        .volume_change_rms = 0.027,
                        .volume_change_worst = -0.31,
                        .worst_grain = 5},
                       folder / "run");
  auto statistics = statistics_of(mesh::measure(cubes()), nullptr, {});
  EXPECT_EQ(table_text(statistics, "run").find("regularisation"), std::string::npos);
  statistics.regularisation = read_regularisation(folder / "run");
  EXPECT_NE(
      table_text(statistics, "run")
          .find("regularisation changed the grains' volumes by 2.7 % rms, grain 5's by -31 %"),
      std::string::npos)
      << table_text(statistics, "run");
  const auto json = nlohmann::json::parse(json_text(statistics, "run"))["regularisation"];
  EXPECT_EQ(json["deletions"], 7);
  EXPECT_EQ(json["short_edges_before"], 9);
  EXPECT_EQ(json["short_edges_after"], 2);
  EXPECT_EQ(json["max_flatness_fault"], 19.5);
  EXPECT_EQ(json["volume_change_rms"], 0.027);
  EXPECT_EQ(json["volume_change_worst"], -0.31);
  EXPECT_EQ(json["worst_grain"], 5);
  std::ofstream(folder / "run/regularisation.json") << "{}";
  EXPECT_THROW(read_regularisation(folder / "run"), core::InputError);
}

TEST(StatisticsFiles, OfAnEarlierCallStay) {
  const tests::TemporaryFolder folder;
  const auto statistics = statistics_of(mesh::measure(cubes()), nullptr, {});
  check_statistics_folder(folder / "out", false);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  write_statistics(folder / "out", statistics, nullptr, "cubes.tess");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/elements.csv"));
  EXPECT_THROW(check_statistics_folder(folder / "out", false), core::InputError);
  check_statistics_folder(folder / "out", true);
  EXPECT_THROW(check_statistics_folder(folder / "out/stats.json", true), core::InputError);
}

}  // namespace
}  // namespace polyslip::results
