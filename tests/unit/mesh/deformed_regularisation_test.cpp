#include "mesh/deformed_regularisation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "mesh/geometry.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

Mesh polycrystal() {
  auto tessellation = voronoi_tessellation(PolycrystalOptions{.grains = 8, .seed = 2});
  regularise(tessellation, {});
  MeshingOptions options;
  options.element_size = 0.6;
  options.meshers = {"gmsh-delaunay"};
  options.jobs = 1;
  MeshingReport report;
  return mesh_geometry(geometry_of(tessellation), options, Vec3::Ones(),
                       *MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher"), report);
}

double worst(const Mesh& mesh, const Vec3& scale) {
  double least = 1;
  for (const auto& t : mesh.tetrahedra) {
    const auto at = [&](int i) -> Vec3 { return mesh.nodes[t[i]].cwiseProduct(scale); };
    least = std::min(least, radius_ratio(at(0), at(1), at(2), at(3)));
  }
  return least;
}

TEST(DeformedRegularisation, LeavesAloneWhatIsGood) {
  Mesh mesh = polycrystal();
  const auto before = mesh.nodes;
  const auto result = regularise_deformed(mesh, Vec3::Ones(), {.least_radius_ratio = 0.05});
  EXPECT_EQ(result.elements_before, 0);
  EXPECT_EQ(result.moved, 0);
  EXPECT_EQ(mesh.nodes, before);
}

TEST(DeformedRegularisation, OpensWhatHasClosed) {
  const Mesh good = polycrystal();
  const Vec3 stretch(1.5, 1, 1 / 1.5), back = stretch.cwiseInverse();
  // Of an inner vertex, and of a node at a wall: pushed through the facets opposite of them.
  for (const bool at_wall : {false, true}) {
    Mesh mesh = good;
    int node = -1;
    for (const int n : mesh.vertex_nodes) {
      const Vec3& x = mesh.nodes[n];
      const bool wall =
          x[2] == 0 && x[0] > 0 && x[1] > 0 && x[0] < mesh.size[0] && x[1] < mesh.size[1];
      const bool inner = x.minCoeff() > 0 && (mesh.size - x).minCoeff() > 0;
      if (at_wall ? wall : inner) node = n;
    }
    ASSERT_GE(node, 0);
    // Towards the neighbour, and a little beyond: elements between them turn inside out.
    const auto t = std::find_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), [&](const auto& e) {
      return std::find(e.begin(), e.begin() + 4, node) != e.begin() + 4;
    });
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < 4; ++i)
      if ((*t)[i] != node) centre += mesh.nodes[(*t)[i]] / 3;
    Vec3 push = 1.1 * (centre - mesh.nodes[node]);
    if (at_wall) push[2] = 0;
    const Vec3 from = mesh.nodes[node];
    double part = 1;
    for (; part > 0.1; part -= 0.1) {  // as far as just suffices
      mesh.nodes[node] = from + (part - 0.1) * push;
      if (worst(mesh, Vec3::Ones()) > 0) break;
    }
    mesh.nodes[node] = from + part * push;
    for (Vec3& x : mesh.nodes) x = x.cwiseProduct(stretch);
    const auto pushed = mesh.nodes;
    ASSERT_LT(worst(mesh, back), 0.01);
    const auto result =
        regularise_deformed(mesh, back, {.least_radius_ratio = 0.05, .largest_move = 0.5});
    EXPECT_GT(result.elements_before, 0);
    EXPECT_EQ(result.elements_after, 0);
    EXPECT_GE(worst(mesh, back), 0.05);
    EXPECT_LE(result.largest_move, 0.5);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const int d = mesh.topology.faces[mesh.triangle_face[i]].domain_face;
      if (d < 0) continue;
      for (const int n : mesh.triangles[i]) EXPECT_EQ(mesh.nodes[n][d / 2], pushed[n][d / 2]);
    }
  }
}

/// Faces of the domain that have turned, in simple shear, stay planes, and their nodes move in
/// them.
TEST(DeformedRegularisation, KeepsLeaningFacesPlane) {
  Mesh mesh = polycrystal();
  constexpr double shear = 0.8;
  for (Vec3& x : mesh.nodes) x[0] += shear * x[2];
  const auto start = mesh.nodes;
  const auto result = regularise_deformed(mesh, Vec3::Ones(), {.least_radius_ratio = 0.3});
  EXPECT_GT(result.moved, 0);
  int moved = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int d = mesh.topology.faces[mesh.triangle_face[i]].domain_face;
    if (d < 0) continue;
    for (const int n : mesh.triangles[i]) {
      const Vec3& x = mesh.nodes[n];
      if (d >= 2) {
        EXPECT_EQ(x[d / 2], start[n][d / 2]);
      } else {
        EXPECT_NEAR(x[0] - shear * x[2], d == 0 ? 0 : mesh.size[0], 1e-12);
        moved += std::abs(x[2] - start[n][2]) > 1e-3;
      }
    }
  }
  EXPECT_GT(moved, 0);
}

TEST(DeformedRegularisation, MovesSurfacesNoFartherThanAsked) {
  Mesh mesh = polycrystal();
  for (Vec3& x : mesh.nodes) x[0] += 2.5 * x[2];  // a shear wears every element
  const auto start = mesh.nodes;
  const auto result =
      regularise_deformed(mesh, Vec3::Ones(), {.least_radius_ratio = 0.2, .largest_move = 0.01});
  EXPECT_GT(result.moved, 0);
  EXPECT_LE(result.largest_move, 0.01 + 1e-12);
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) EXPECT_LE((mesh.nodes[t[k]] - start[t[k]]).norm(), 0.01 + 1e-12);
}

}  // namespace
}  // namespace polyslip::mesh
