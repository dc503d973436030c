#include "mesh/measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/volume_mesher.hpp"
#include "support/box_mesh.hpp"
#include "two_tetrahedra.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using std::numbers::pi;

/// n x n x n unit cubes.
Tessellation cubes(int n) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) seeds.emplace_back(i + 0.5, j + 0.5, k + 0.5);
  return voronoi_tessellation(seeds, Vec3::Constant(n));
}

TEST(Measures, OfCubes) {
  const Measures m = measure(cubes(3));
  ASSERT_EQ(m.grains.size(), 27U);
  int inner = 0;
  for (std::size_t c = 0; c < m.grains.size(); ++c) {
    const GrainMeasures& g = m.grains[c];
    EXPECT_EQ(g.faces, 6);
    EXPECT_EQ(g.edges, 12);
    EXPECT_EQ(g.vertices, 8);
    EXPECT_NEAR(g.volume, 1, 1e-12);
    EXPECT_NEAR(g.area, 6, 1e-12);
    EXPECT_NEAR(g.diameter(), std::cbrt(6 / pi), 1e-12);
    EXPECT_NEAR(g.sphericity(), std::cbrt(pi / 6), 1e-12);  // 0.806
    EXPECT_EQ(g.inner, c == 13);
    inner += g.inner;
    const Vec3 centre(0.5 + static_cast<double>(c / 9), 0.5 + static_cast<double>(c / 3 % 3),
                      0.5 + static_cast<double>(c % 3));
    EXPECT_LT((g.centroid - centre).norm(), 1e-12);
  }
  EXPECT_EQ(inner, 1);
  EXPECT_EQ(m.grains[13].neighbours, 6);
  EXPECT_EQ(m.grains[0].neighbours, 3);
  ASSERT_EQ(m.faces.size(), 108U);
  for (const FaceMeasures& f : m.faces) {
    EXPECT_EQ(f.edges, 4);
    EXPECT_NEAR(f.area, 1, 1e-12);
    EXPECT_NEAR(f.diameter(), 2 / std::sqrt(pi), 1e-12);
    EXPECT_NEAR(f.flatness_fault, 0, 1e-5);
    EXPECT_NEAR(f.least_corner, 90, 1e-9);
    EXPECT_EQ(f.cells[1] < 0, f.domain_face >= 0);
  }
  EXPECT_EQ(std::count_if(m.faces.begin(), m.faces.end(), [](auto& f) { return f.inner; }), 6);
  ASSERT_EQ(m.edges.size(), 144U);
  int inner_edges = 0;
  for (const EdgeMeasures& e : m.edges) {
    EXPECT_NEAR(e.length, 1, 1e-12);
    if (!e.inner) continue;
    ++inner_edges;
    EXPECT_EQ(e.faces, 4);
  }
  EXPECT_EQ(inner_edges, 12);
}

/// Lattice points of a cubic lattice of constant 1 with a basis, in a box of n cells.
std::vector<Vec3> lattice(int n, const std::vector<Vec3>& basis) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const Vec3& x : basis) seeds.push_back(Vec3(i, j, k) + x);
  return seeds;
}

TEST(Measures, OfTruncatedOctahedra) {
  const double q = 0.25;
  const auto seeds = lattice(3, {{q, q, q}, {3 * q, 3 * q, 3 * q}});
  const Measures m = measure(voronoi_tessellation(seeds, Vec3::Constant(3)));
  // Edge a: volume 8 sqrt 2 a^3 = 1/2; six squares and eight hexagons.
  const double a = std::cbrt(1 / (16 * std::sqrt(2.0)));
  int inner = 0;
  for (const GrainMeasures& g : m.grains) {
    if (!g.inner || (g.centroid - Vec3::Constant(1.5)).cwiseAbs().maxCoeff() > 0.5) continue;
    ++inner;
    EXPECT_EQ(g.faces, 14);
    EXPECT_EQ(g.edges, 36);
    EXPECT_EQ(g.vertices, 24);
    EXPECT_NEAR(g.volume, 0.5, 1e-9);
    EXPECT_NEAR(g.area, (6 + 12 * std::sqrt(3.0)) * a * a, 1e-9);
    EXPECT_NEAR(g.sphericity(), 0.9099, 1e-4);
  }
  EXPECT_EQ(inner, 2);
}

TEST(Measures, OfRhombicDodecahedra) {
  const double q = 0.25, h = 0.75;
  const auto seeds = lattice(3, {{q, q, q}, {q, h, h}, {h, q, h}, {h, h, q}});
  const Measures m = measure(voronoi_tessellation(seeds, Vec3::Constant(3)));
  int inner = 0;
  for (const GrainMeasures& g : m.grains) {
    if (!g.inner || (g.centroid - Vec3::Constant(1.5)).cwiseAbs().maxCoeff() > 0.5) continue;
    ++inner;
    EXPECT_EQ(g.faces, 12);
    EXPECT_EQ(g.edges, 24);
    EXPECT_EQ(g.vertices, 14);
    EXPECT_NEAR(g.volume, 0.25, 1e-9);
    EXPECT_NEAR(g.sphericity(), 0.9047, 1e-4);
    EXPECT_EQ(g.neighbours, 12);
  }
  EXPECT_EQ(inner, 4);
  for (const FaceMeasures& f : m.faces) {
    if (!f.inner) continue;
    EXPECT_NEAR(f.least_corner, std::acos(1.0 / 3) * 180 / pi, 1e-6);
  }
}

TEST(Measures, FlatnessFaultIsThatOfTheInterpolationTriangles) {
  PolycrystalOptions options;
  options.grains = 60;
  Tessellation t = voronoi_tessellation(options);
  const Measures raw = measure(t);
  for (const FaceMeasures& f : raw.faces) EXPECT_LT(f.flatness_fault, 1e-3);
  regularise(t, {});
  const Measures m = measure(t);
  double largest = 0, volume = 0;
  for (std::size_t f = 0; f < m.faces.size(); ++f) {
    EXPECT_DOUBLE_EQ(m.faces[f].flatness_fault, flatness_fault(t, static_cast<int>(f)));
    largest = std::max(largest, m.faces[f].flatness_fault);
  }
  EXPECT_GT(largest, 5);
  for (std::size_t c = 0; c < m.grains.size(); ++c) {
    EXPECT_NEAR(m.grains[c].volume, cell_volume(t, static_cast<int>(c)), 1e-12);
    volume += m.grains[c].volume;
    EXPECT_LT(m.grains[c].sphericity(), 0.95);
    EXPECT_GT(m.grains[c].sphericity(), 0.3);
  }
  EXPECT_NEAR(volume, 60, 1e-9);
}

// A torus has V - E + F - C = 0; four grains meet at a vertex, three faces at an edge.
TEST(Measures, CountPeriodicTranslatesOnce) {
  for (const bool regularised : {false, true}) {
    PolycrystalOptions options;
    options.grains = 40;
    options.periodic = {true, true, true};
    Tessellation t = voronoi_tessellation(options);
    if (regularised) regularise(t, {});
    const Measures m = measure(t);
    int faces = 0, edges = 0, sides = 0, of_grains = 0, sides_of_faces = 0;
    for (const FaceMeasures& f : m.faces) {
      EXPECT_GE(f.cells[1], 0);
      EXPECT_TRUE(f.inner);
      if (f.is_translate) continue;
      ++faces;
      sides_of_faces += f.edges;
    }
    for (const EdgeMeasures& e : m.edges) {
      EXPECT_TRUE(e.inner);
      if (e.is_translate) continue;
      ++edges;
      sides += e.faces;
      if (!regularised) {
        EXPECT_EQ(e.faces, 3);
      }
    }
    for (const GrainMeasures& g : m.grains) {
      EXPECT_TRUE(g.inner);
      EXPECT_GE(g.neighbours, 4);
      of_grains += g.faces;
    }
    EXPECT_EQ(of_grains, 2 * faces);
    EXPECT_EQ(sides, sides_of_faces);
    EXPECT_EQ(m.vertices - edges + faces - 40, 0);
    if (!regularised) {
      EXPECT_EQ(edges, 2 * m.vertices);
    }
  }
}

TEST(Measures, OfAMeshOfSlabs) {
  const Mesh mesh = tests::box_mesh({4, 2, 2}, {4, 2, 2}, 2);
  const Measures m = measure(mesh);
  ASSERT_EQ(m.grains.size(), 2U);
  for (const GrainMeasures& g : m.grains) {
    EXPECT_FALSE(g.inner);
    EXPECT_NEAR(g.volume, 8, 1e-12);
    EXPECT_NEAR(g.area, 24, 1e-12);
    EXPECT_EQ(g.faces, 6);
    EXPECT_EQ(g.edges, 12);
    EXPECT_EQ(g.neighbours, 1);
    EXPECT_NEAR(g.sphericity(), std::cbrt(pi / 6), 1e-12);
  }
  EXPECT_LT((m.grains[1].centroid - Vec3(3, 1, 1)).norm(), 1e-12);
  for (const FaceMeasures& f : m.faces) {
    EXPECT_NEAR(f.area, 4, 1e-12);
    EXPECT_NEAR(f.flatness_fault, 0, 1e-6);
    EXPECT_NEAR(f.least_corner, 90, 1e-9);
  }
  for (const EdgeMeasures& e : m.edges) EXPECT_NEAR(e.length, 2, 1e-12);
  // Kuhn's tetrahedron of the unit cube: edges 1, 1, 1, sqrt 2, sqrt 2, sqrt 3; r_in = 3 V / A with
  // A = 1 + sqrt 2, R_circ = sqrt 3 / 2.
  const ElementMeasures e = measure_element(mesh, 5);
  EXPECT_NEAR(e.size, (3 + 2 * std::sqrt(2.0) + std::sqrt(3.0)) / 6, 1e-12);
  EXPECT_NEAR(e.radius_ratio, 3 * (0.5 / (1 + std::sqrt(2.0))) / (std::sqrt(3.0) / 2), 1e-12);
}

TEST(Measures, OfOrderOne) {
  Mesh mesh = tests::box_mesh({2, 2, 2}, {2, 2, 2}, 1);
  mesh.order = 1;
  const Measures m = measure(mesh);
  EXPECT_NEAR(m.grains[0].volume, 8, 1e-12);
  EXPECT_NEAR(m.grains[0].area, 24, 1e-12);
  for (const EdgeMeasures& e : m.edges) EXPECT_NEAR(e.length, 2, 1e-12);
}

TEST(Measures, OfCurvedLinesAndTriangles) {
  Mesh mesh = two_tetrahedra();
  // The line between nodes 0 and 1 becomes a parabola of height h: length (sqrt(1 + 16 h^2) +
  // asinh(4 h)/(4 h))/2.
  const double h = 0.05;
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
    if (std::min(mesh.lines[i][0], mesh.lines[i][1]) == 0 &&
        std::max(mesh.lines[i][0], mesh.lines[i][1]) == 1)
      mesh.nodes[mesh.lines[i][2]] = Vec3(0.5, 0, -h);
  const Measures m = measure(mesh);
  bool found = false;
  for (const EdgeMeasures& e : m.edges)
    if (std::min(e.vertices[0], e.vertices[1]) == 0 &&
        std::max(e.vertices[0], e.vertices[1]) == 1) {
      EXPECT_NEAR(e.length, (std::sqrt(1 + 16 * h * h) + std::asinh(4 * h) / (4 * h)) / 2, 1e-6);
      found = true;
    }
  EXPECT_TRUE(found);
  // The face in the plane y = 0 gains the area under the parabola, 2 h / 3, and stays plane.
  const auto plane = std::find_if(mesh.triangles.begin(), mesh.triangles.end(), [](const auto& t) {
    return (t[0] | t[1] | t[2]) == 3 && t[0] + t[1] + t[2] == 4;
  });
  ASSERT_NE(plane, mesh.triangles.end());
  EXPECT_NEAR(m.faces[mesh.triangle_face[plane - mesh.triangles.begin()]].area, 0.5 + 2 * h / 3,
              1e-12);
}

TEST(Measures, CriterionIsThatOfTheMeshers) {
  Mesh mesh = tests::box_mesh({4, 2, 2}, {4, 2, 2}, 2);
  tests::distort(mesh, 0.2);
  const auto grains = measure_grain_meshes(mesh, 0.9);
  ASSERT_EQ(grains.size(), 2U);
  const auto own_sizes = measure_grain_meshes(mesh, std::vector<double>{0.9, 0.4});
  EXPECT_EQ(own_sizes[0].O, grains[0].O);
  EXPECT_EQ(own_sizes[1].O_dis, grains[1].O_dis);
  EXPECT_EQ(own_sizes[1].O_size, measure_grain_meshes(mesh, 0.4)[1].O_size);
  for (int c = 0; c < 2; ++c) {
    VolumeMesh part;
    part.nodes = mesh.nodes;
    double least = 1, sum = 0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.tetrahedron_cell[e] != c) continue;
      const auto& t = mesh.tetrahedra[e];
      part.tetrahedra.push_back({t[0], t[1], t[2], t[3]});
      least = std::min(least, measure_element(mesh, e).radius_ratio);
      sum += measure_element(mesh, e).radius_ratio;
    }
    EXPECT_EQ(grains[c].elements, static_cast<int>(part.tetrahedra.size()));
    EXPECT_DOUBLE_EQ(grains[c].O, mesh_quality_O(part, 0.9));
    EXPECT_NEAR(std::pow(grains[c].O_dis, 0.8) * std::pow(grains[c].O_size, 0.2), grains[c].O,
                1e-12);
    EXPECT_GT(grains[c].O, 0.1);
    EXPECT_LT(grains[c].O_size, 1);
    EXPECT_DOUBLE_EQ(grains[c].min_radius_ratio, least);
    EXPECT_NEAR(grains[c].mean_radius_ratio, sum / grains[c].elements, 1e-12);
  }
}

TEST(Measures, SpoiltElementsShow) {
  Mesh mesh = tests::box_mesh({2, 2, 2}, {2, 2, 2}, 1);
  mesh.nodes[mesh.tetrahedra[3][1]].x() = std::nan("");
  const auto grains = measure_grain_meshes(mesh, 1);
  EXPECT_TRUE(std::isnan(grains[0].min_radius_ratio));
  EXPECT_EQ(grains[0].O, 0);
}

}  // namespace
}  // namespace polyslip::mesh
