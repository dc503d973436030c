// The whole pipeline with the real meshers: first mesh and remeshing of a polycrystal.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/error.hpp"
#include "mesh/geometry.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

std::unique_ptr<MesherPool> start_pool() {
  return MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
}

Tessellation polycrystal(int grains, std::uint64_t seed) {
  auto t = voronoi_tessellation(PolycrystalOptions{.grains = grains, .seed = seed});
  regularise(t, RegularisationOptions{});
  return t;
}

void expect_identical(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.nodes, b.nodes);
}

/// Shears of a grain's wavelength whose determinant is one, then plane strain.
void deform(Mesh& mesh, double strain, double amplitude) {
  for (auto& x : mesh.nodes) {
    x[0] += amplitude * std::sin(2.9 * x[1] + 0.3) * std::sin(3.1 * x[2]);
    x[1] += amplitude * std::sin(3.3 * x[2] + 0.7) * std::cos(2.7 * x[0]);
    x[2] += amplitude * std::cos(3.0 * x[0] + 0.2) * std::sin(2.8 * x[1]);
    x = x.cwiseProduct(Vec3(std::exp(strain), 1, std::exp(-strain)));
  }
}

TEST(PolycrystalMesh, FillsTheBoxOfARegularisedPolycrystal) {
  const auto pool = start_pool();
  for (double size : {0.5, 0.9}) {
    const auto tessellation = polycrystal(30, 1);
    MeshingOptions options;
    options.element_size = size;
    MeshingReport report;
    std::vector<std::string> stages;
    std::vector<double> grains;
    const auto progress = [&](const std::string& stage, double fraction) {
      if (stages.empty() || stages.back() != stage) stages.push_back(stage);
      if (stage == "meshing grains") grains.push_back(fraction);
    };
    const Mesh mesh =
        mesh_geometry(geometry_of(tessellation), options, Vec3::Ones(), *pool, report, progress);
    ASSERT_NO_THROW(check(mesh));
    const auto volumes = grain_volumes(mesh);
    EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0) / 30, 1, 1e-12);
    for (int c = 0; c < 30; ++c) EXPECT_NEAR(volumes[c], cell_volume(tessellation, c), 0.02);
    EXPECT_GT(quality(mesh).min_radius_ratio, 0.08);
    EXPECT_GT(quality(mesh).mean_radius_ratio, 0.6);
    if (size == 0.5) {
      EXPECT_GT(report.mean_O, 0.88);
    }
    EXPECT_EQ(std::accumulate(report.wins.begin(), report.wins.end(), 0), 30);
    EXPECT_TRUE(report.faults.empty());
    EXPECT_EQ(stages, (std::vector<std::string>{"meshing faces", "meshing grains", "sliding nodes",
                                                "meshing poor grains", "assembling"}));
    EXPECT_TRUE(std::is_sorted(grains.begin(), grains.end()));
    ASSERT_EQ(grains.size(), 30u);
    EXPECT_EQ(grains.back(), 1.0);
    for (const char* stage : {"faces", "meshing", "sliding", "assembly"})
      EXPECT_GT(report.times.seconds(stage), 0) << stage;
  }
}

TEST(PolycrystalMesh, SurvivesFaultsOfMeshersAndNamesAGrainThatNoneCanMesh) {
  const auto geometry = geometry_of(polycrystal(8, 4));
  MeshingOptions options;
  options.mesher_timeout = 2;
  const auto pool_with = [](const char* faults) {
    setenv("POLYSLIP_MESHER_FAULT", faults, 1);
    auto pool = start_pool();
    unsetenv("POLYSLIP_MESHER_FAULT");
    return pool;
  };
  MeshingReport report;
  const auto some = pool_with(
      "gmsh-hxt:0:crash,gmsh-hxt:3:hang,gmsh-delaunay:3:nan,gmsh-hxt:5:move,gmsh-hxt:6:garbage");
  const Mesh mesh = mesh_geometry(geometry, options, Vec3::Ones(), *some, report);
  ASSERT_NO_THROW(check(mesh));
  EXPECT_EQ(report.faults.size(), 5u);
  const auto all = pool_with("gmsh-hxt:3:crash,gmsh-delaunay:3:throw,netgen:3:move");
  try {
    mesh_geometry(geometry, options, Vec3::Ones(), *all, report);
    FAIL() << "no grain is missing";
  } catch (const core::RecoverableError& error) {
    EXPECT_EQ(std::string(error.what()).find("grain 4 could not be meshed by any of 3 meshers: "),
              0u)
        << error.what();
  }
}

TEST(PolycrystalMesh, HasFineInnerAndCoarseOuterGrainsIfAsked) {
  const auto pool = start_pool();
  const auto tessellation = polycrystal(60, 3);
  MeshingOptions options;
  options.element_size = 0.25;
  options.outer_element_size = 0.5;
  MeshingReport report;
  const Mesh mesh = mesh_geometry(geometry_of(tessellation), options, Vec3::Ones(), *pool, report);
  ASSERT_NO_THROW(check(mesh));
  std::vector<char> outer(60, false);
  for (const auto& f : mesh.topology.faces)
    if (f.domain_face >= 0) outer[f.cells[0]] = true;
  const auto volumes = grain_volumes(mesh);
  std::array<double, 2> elements{}, volume{};
  for (int c : mesh.tetrahedron_cell) ++elements[outer[c]];
  for (int c = 0; c < 60; ++c) volume[outer[c]] += volumes[c];
  // 670 elements a unit volume at 0.25 and 108 at 0.5; outer grains border on inner ones.
  EXPECT_NEAR(elements[0] / volume[0], 670, 170);
  EXPECT_LT(elements[1] / volume[1], 300);
}

TEST(PolycrystalMesh, IsNoWorseThanByItsFirstMesherAlone) {
  const auto pool = start_pool();
  const auto geometry = geometry_of(polycrystal(20, 4));
  MeshingOptions options;
  options.meshers = {"paper-1"};
  MeshingReport alone, both;
  const Mesh by_one = mesh_geometry(geometry, options, Vec3::Ones(), *pool, alone);
  options.meshers = {"paper-1", "gmsh-hxt"};
  options.mesher_target = 0.999;  // nearly all grains are tried again
  const Mesh by_both = mesh_geometry(geometry, options, Vec3::Ones(), *pool, both);
  ASSERT_NO_THROW(check(by_both));
  EXPECT_GT(both.wins[1], 0);
  EXPECT_GT(both.mean_O, alone.mean_O);
  EXPECT_GE(quality(by_both).min_radius_ratio, quality(by_one).min_radius_ratio);
}

TEST(PolycrystalMesh, TakesFacesOfOtherMeshersIfAsked) {
  const auto pool = start_pool();
  const auto geometry = geometry_of(polycrystal(20, 4));
  const int faces = static_cast<int>(geometry.topology.faces.size());
  MeshingOptions options;
  MeshingReport report;
  const Mesh own = mesh_geometry(geometry, options, Vec3::Ones(), *pool, report);
  EXPECT_EQ(report.face_wins, std::vector<int>{faces});
  options.face_meshers = {"gmsh-delaunay"};
  const Mesh other = mesh_geometry(geometry, options, Vec3::Ones(), *pool, report);
  ASSERT_NO_THROW(check(other));
  EXPECT_EQ(report.face_wins, std::vector<int>{faces});
  EXPECT_NE(own.triangles, other.triangles);
  EXPECT_GT(report.mean_O, 0.8);
}

TEST(PolycrystalMesh, IsTheSameForAnyNumberOfWorkers) {
  const auto pool = start_pool();
  const auto geometry = geometry_of(polycrystal(12, 4));
  MeshingOptions options;
  MeshingReport report;
  options.jobs = 1;
  const Mesh one = mesh_geometry(geometry, options, Vec3::Ones(), *pool, report);
  options.jobs = 3;
  expect_identical(one, mesh_geometry(geometry, options, Vec3::Ones(), *pool, report));
}

TEST(PolycrystalMesh, RemeshingKeepsGrainVolumesAndImprovesTheElements) {
  const auto pool = start_pool();
  MeshingOptions options;
  MeshingReport report;
  Mesh old = mesh_geometry(geometry_of(polycrystal(30, 2)), options, Vec3::Ones(), *pool, report);
  deform(old, 0.3, 0.08);
  const auto before = grain_volumes(old);
  for (const Vec3& scale : {Vec3(1, 1, 1), Vec3(std::exp(-0.3), 1, std::exp(0.3))}) {
    const Mesh mesh = mesh_geometry(geometry_of(old), options, scale, *pool, report);
    ASSERT_NO_THROW(check(mesh));
    const auto after = grain_volumes(mesh);
    double worst = 0;
    for (int c = 0; c < 30; ++c) worst = std::max(worst, std::abs(after[c] / before[c] - 1));
    EXPECT_LT(worst, 1e-5);
    EXPECT_GT(worst, 0);
    EXPECT_TRUE(report.copied_faces.empty());
    if (scale == Vec3(1, 1, 1)) {
      EXPECT_GT(quality(mesh).mean_radius_ratio, quality(old).mean_radius_ratio + 0.03);
    }
  }
}

}  // namespace
}  // namespace polyslip::mesh
