// What the numbers of a run promise: the curve crosses the remeshing, grains keep their volume, the
// box stays a box, forces balance.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "mesh/mesh.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

/// One run for all these tests: states at 0, 0.02, 0.03 before and after the remeshing, 0.06.
class Physics : public ::testing::Test {
 protected:
  enum State : std::size_t { start, middle, before, after, end };

  static void SetUpTestSuite() {
    sandbox_ = std::make_unique<Sandbox>();
    run_deck(*sandbox_, 1, small_deck(), "run");
  }
  static void TearDownTestSuite() { sandbox_.reset(); }
  void SetUp() override {
    ASSERT_EQ(state_count(run()), 5u);
    rows_ = read_macro(run());
    ASSERT_GT(rows_.size(), 15u);
  }
  static fs::path run() { return sandbox_->path() / "run"; }
  static mesh::Snapshot state(State which) { return state_of(run(), which); }

  std::vector<MacroRow> rows_;
  static std::unique_ptr<Sandbox> sandbox_;
};

std::unique_ptr<Sandbox> Physics::sandbox_;

/// Largest relative change of a grain's volume.
double volume_change(const mesh::Mesh& a, const mesh::Mesh& b) {
  const auto from = mesh::grain_volumes(a), to = mesh::grain_volumes(b);
  if (from.size() != 8u || to.size() != 8u) return NAN;
  double largest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double change = std::abs(to[i] / from[i] - 1);
    if (!(change <= largest)) largest = change;
  }
  return largest;
}

/// Within 1 % of the curve before, gone on in a straight line, once reloaded: 0.005 of strain
/// later.
TEST_F(Physics, CurveCrossesTheRemeshing) {
  std::size_t first = 0;
  while (first < rows_.size() && !rows_[first].remeshed) ++first;
  ASSERT_GT(first, 2u);
  ASSERT_LT(first + 5, rows_.size());
  const MacroRow &a = rows_[first - 2], &b = rows_[first - 1];
  EXPECT_EQ(b.strain, 0.03);
  const double slope = (b.von_mises() - a.von_mises()) / (b.strain - a.strain);
  int seen = 0;
  for (std::size_t i = first; i < rows_.size(); ++i) {
    if (rows_[i].strain < 0.035 || rows_[i].strain > 0.045) continue;
    const double expected = b.von_mises() + slope * (rows_[i].strain - b.strain);
    EXPECT_NEAR(rows_[i].von_mises() / expected, 1, 0.01) << "strain " << rows_[i].strain;
    ++seen;
  }
  EXPECT_GT(seen, 1);
}

TEST_F(Physics, StrainToReloadIsShort) {
  const auto summary = nlohmann::json::parse(slurp(run() / "summary.json"));
  ASSERT_EQ(summary.at("remeshings").size(), 1u);
  const double strain = summary["remeshings"][0].at("strain_to_reload");
  EXPECT_GT(strain, 0.0005);
  EXPECT_LT(strain, 0.01);
}

TEST_F(Physics, GrainsKeepTheirVolume) {
  EXPECT_LT(volume_change(state(start).mesh, state(before).mesh), 1e-3);
  EXPECT_LT(volume_change(state(before).mesh, state(after).mesh), 5e-3);
  EXPECT_LT(volume_change(state(after).mesh, state(end).mesh), 1e-3);
  EXPECT_LT(volume_change(state(start).mesh, state(end).mesh), 5e-3);
  const auto summary = nlohmann::json::parse(slurp(run() / "summary.json"));
  EXPECT_NEAR(summary["remeshings"][0].at("max_grain_volume_change").get<double>(),
              volume_change(state(before).mesh, state(after).mesh), 1e-9);
}

/// z1 stands at h0 exp(-strain); z0, x0, y0 and y1 where they were.
TEST_F(Physics, PrescribedFacesAreWhereTheyShouldBe) {
  for (const State which : {start, middle, before, after, end}) {
    const mesh::Snapshot snapshot = state(which);
    const mesh::Mesh& mesh = snapshot.mesh;
    const core::Vec3& size = mesh.size;
    const double place[6] = {0, NAN, 0, size[1], 0, size[2] * std::exp(-snapshot.strain)};
    int seen[6] = {};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const int face = mesh.topology.faces[mesh.triangle_face[t]].domain_face;
      if (face < 0 || face == 1) continue;
      ++seen[face];
      for (const int node : mesh.triangles[t])
        ASSERT_NEAR(mesh.nodes[node][face / 2], place[face], 1e-12 * size[face / 2])
            << "face " << face << " at strain " << snapshot.strain;
    }
    for (const int face : {0, 2, 3, 4, 5}) EXPECT_GT(seen[face], 0);
  }
}

/// Nothing pulls at the free face: sxx, averaged over the volume, is under 1 % of the flow stress.
TEST_F(Physics, FreeFaceIsFree) {
  const double flow_stress = rows_.back().von_mises();
  EXPECT_GT(flow_stress, 10);
  for (const MacroRow& row : rows_) {
    EXPECT_LT(std::abs(row.stress[0]), 0.01 * flow_stress) << row.strain;
    EXPECT_LT(std::abs(row.fx_x1), 1e-3 * std::abs(row.fz_z1)) << row.strain;
  }
}

/// Reactions balance the stresses: with V the volume and h the height, fz h = szz V, as no other
/// face carries a force along z; likewise along y. To the Newton tolerance.
TEST_F(Physics, ForcesBalanceStresses) {
  const core::Vec3 size = state(start).mesh.size;
  const double volume = size.prod();
  const double elastic = 1e-3;  // change of the volume
  for (const MacroRow& row : rows_) {
    const double height = size[2] * std::exp(-row.strain);
    const double scale = std::abs(row.stress[2]) * volume;
    EXPECT_NEAR(row.fz_z1 * height, row.stress[2] * volume, (1e-3 + elastic) * scale);
    EXPECT_NEAR(row.fy_y1 * size[1], row.stress[1] * volume, (1e-3 + elastic) * scale);
    EXPECT_GT(scale, 0);
  }
}

/// Time goes with strain at the deck's rate; steps are those of the strain.
TEST_F(Physics, TimeAndStepsFollowTheStrain) {
  double last = 0;
  for (const MacroRow& row : rows_) {
    EXPECT_NEAR(row.strain - last, row.step_size, 1e-12);
    EXPECT_NEAR(row.time, row.strain, 1e-12);  // 1/s
    EXPECT_LE(row.step_size, 0.01 + 1e-12);
    last = row.strain;
  }
  EXPECT_EQ(last, 0.06);
}

}  // namespace
}  // namespace polyslip::tests
