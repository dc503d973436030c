// Remeshing without a solver: polycrystals moved by plane strain and a random flow of a grain's
// wavelength (support/grain_flow.hpp) are remeshed up to a strain of 2.5. Limits are those of the
// project, for each remeshing: the mesh passes check(), at most 1 % of the faces are copied, grain
// volumes change by less than 0.1 % rms and 0.3 % at worst, and the worst radius ratio, in the
// frame of sizes, which is the one scaled back to isotropy here, is at least half of that of the
// first mesh.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/geometry.hpp"
#include "remap/remesh.hpp"
#include "support/grain_flow.hpp"

namespace polyslip::remap {
namespace {

using core::Vec3;

constexpr double end = 2.5, interval = 0.25;
constexpr double least_share = 0.5;  ///< of the first mesh's worst radius ratio

struct Outcome {
  int remeshings = 0;
  double rms = 0, worst = 0;
};

void compare_volumes(const std::vector<double>& before, const std::vector<double>& after,
                     Outcome& outcome) {
  double sum = 0;
  for (std::size_t g = 0; g < before.size(); ++g) {
    const double change = after[g] / before[g] - 1;
    sum += change * change / static_cast<double>(before.size());
    outcome.worst = std::max(outcome.worst, std::abs(change));
  }
  outcome.rms = std::max(outcome.rms, std::sqrt(sum));
}

double quality_of(const mesh::Mesh& mesh) {
  return test::scaled_quality(mesh, mesh::isotropic_scale(mesh)).min_radius_ratio;
}

mesh::Mesh first_mesh(int grains, std::uint64_t seed, const mesh::MeshingOptions& meshing,
                      mesh::MesherPool& pool, mesh::MeshingReport& report) {
  auto tessellation = mesh::voronoi_tessellation({.grains = grains, .seed = seed});
  mesh::regularise(tessellation, {});
  return mesh::mesh_geometry(mesh::geometry_of(tessellation), meshing, Vec3::Ones(), pool, report);
}

void remesh_to_the_end(int grains, double element_size, const test::GrainFlow::Options& options,
                       mesh::MesherPool& pool, Outcome& outcome) {
  mesh::MeshingOptions meshing;
  meshing.element_size = element_size;
  mesh::MeshingReport report;
  mesh::Mesh mesh = first_mesh(grains, options.seed, meshing, pool, report);
  const double first = test::scaled_quality(mesh, Vec3::Ones()).min_radius_ratio;
  const test::GrainFlow flow(mesh.size, options);
  RemeshingOptions remeshing;
  remeshing.lengthening_share = 1;
  for (double strain = 0; strain < end - 1e-9; strain += interval) {
    flow.move(mesh, strain, strain + interval);
    const auto before = mesh::grain_volumes(mesh);
    mesh::DeformedRegularisation regularisation;
    const auto geometry = regularised_geometry(mesh, remeshing, regularisation);
    const Vec3 scale = meshing_scale(mesh, remeshing);
    mesh = mesh::mesh_geometry(geometry, meshing, scale, pool, report);
    ASSERT_NO_THROW(mesh::check(mesh));
    EXPECT_EQ(report.opened.elements_after, 0) << "at strain " << strain + interval;
    EXPECT_EQ(regularisation.elements_after, 0) << "at strain " << strain + interval;
    compare_volumes(before, mesh::grain_volumes(mesh), outcome);
    EXPECT_GE(quality_of(mesh), least_share * first)
        << "seed " << options.seed << " at strain " << strain + interval;
    EXPECT_LE(report.copied_faces.size(), mesh.topology.faces.size() / 100)
        << "seed " << options.seed << " at strain " << strain + interval;
    ++outcome.remeshings;
  }
}

void expect_limits(const Outcome& outcome, int remeshings) {
  EXPECT_EQ(outcome.remeshings, remeshings);
  EXPECT_LT(outcome.rms, 1e-3);
  EXPECT_LT(outcome.worst, 3e-3);
}

std::unique_ptr<mesh::MesherPool> start_pool() {
  return mesh::MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
}

TEST(RemeshingGeometry, OfASmallPolycrystal) {
  const auto pool = start_pool();
  Outcome outcome;
  remesh_to_the_end(10, 0.7, {.strength = 0.3, .seed = 1}, *pool, outcome);
  expect_limits(outcome, 10);
}

/// At a strain of 2 two new faces of a grain meet; copying both would be more than 1 %.
TEST(RemeshingGeometry, CopiesOneOfTwoFacesThatMeet) {
  const auto pool = start_pool();
  Outcome outcome;
  remesh_to_the_end(30, 0.5, {.strength = 0.4, .seed = 15}, *pool, outcome);
  expect_limits(outcome, 10);
}

/// Where the mesh on the old faces is thin, nodes leave these until it is not, and volumes are
/// mended.
TEST(RemeshingGeometry, OpensWhatTheNewMeshLeavesThin) {
  const auto pool = start_pool();
  const test::GrainFlow::Options options{.strength = 0.6, .seed = 12};
  mesh::MeshingOptions meshing;
  meshing.element_size = 0.7;
  mesh::MeshingReport report;
  mesh::Mesh mesh = first_mesh(10, options.seed, meshing, *pool, report);
  EXPECT_EQ(report.opened.elements_before, 0);
  const test::GrainFlow flow(mesh.size, options);
  int thin = 0, moved = 0;
  for (const double strain : {0.0, 0.4}) {
    flow.move(mesh, strain, strain + 0.4);
    const auto before = mesh::grain_volumes(mesh);
    const Vec3 scale = mesh::isotropic_scale(mesh);
    mesh = mesh::mesh_geometry(mesh::geometry_of(mesh), meshing, scale, *pool, report);
    ASSERT_NO_THROW(mesh::check(mesh));
    thin += report.opened.elements_before;
    moved += report.opened.moved;
    EXPECT_EQ(report.opened.elements_after, 0);
    EXPECT_GE(quality_of(mesh), 0.2);
    Outcome outcome;
    compare_volumes(before, mesh::grain_volumes(mesh), outcome);
    expect_limits(outcome, 0);
  }
  EXPECT_GT(thin, 0);
  EXPECT_GT(moved, 0);
}

/// Sides that lean stay as plane as upright ones.
TEST(RemeshingGeometry, FacesTurnedBySimpleShearStayPlane) {
  const auto pool = start_pool();
  mesh::MeshingOptions meshing;
  meshing.element_size = 0.7;
  mesh::MeshingReport report;
  mesh::Mesh mesh = first_mesh(10, 3, meshing, *pool, report);
  constexpr double shear = 0.6, bump = 0.1, pi = 3.14159265358979;
  for (Vec3& x : mesh.nodes) {
    const Vec3 s = (pi * x.cwiseQuotient(mesh.size)).array().sin();
    x += bump * s.prod() * Vec3(1, -0.5, 0.7);
    x[0] += shear * x[2];
  }
  const mesh::Mesh fresh =
      mesh::mesh_geometry(mesh::geometry_of(mesh), meshing, meshing_scale(mesh, {}), *pool, report);
  ASSERT_NO_THROW(mesh::check(fresh));
  int counted = 0;
  for (std::size_t i = 0; i < fresh.triangles.size(); ++i) {
    const int face = fresh.topology.faces[fresh.triangle_face[i]].domain_face;
    if (face != 0 && face != 1) continue;
    for (const int n : fresh.triangles[i]) {
      const Vec3& x = fresh.nodes[n];
      EXPECT_NEAR(x[0] - shear * x[2], face == 0 ? 0 : fresh.size[0], 1e-12);
      ++counted;
    }
  }
  EXPECT_GT(counted, 100);
}

TEST(RemeshingGeometry, SlowTwentyPolycrystals) {
  const auto pool = start_pool();
  Outcome outcome;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    remesh_to_the_end(30, 0.5, {.strength = seed % 2 == 0 ? 0.2 : 0.4, .seed = seed}, *pool,
                      outcome);
  expect_limits(outcome, 200);
}

}  // namespace
}  // namespace polyslip::remap
