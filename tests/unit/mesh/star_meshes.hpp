#pragma once
// Meshes of grains without a mesher's program.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/pipeline.hpp"
#include "surfaces.hpp"

namespace polyslip::mesh::test {

using core::Vec3;

/// Joins each surface triangle to the middle of the grain: valid if the grain is star-shaped.
inline std::vector<GrainResult> star_meshes(const std::vector<GrainRequest>& requests) {
  std::vector<GrainResult> results;
  for (const auto& r : requests) {
    GrainResult result{
        .grain = r.grain, .ok = true, .mesh = {}, .mesher = "star", .O = 1, .faults = {}};
    result.mesh.nodes = r.surface.nodes;
    Vec3 sum = Vec3::Zero();
    for (const auto& x : r.surface.nodes) sum += x;
    const int middle = static_cast<int>(result.mesh.nodes.size());
    result.mesh.nodes.push_back(sum / middle);
    for (const auto& t : r.surface.triangles)
      result.mesh.tetrahedra.push_back({t[0], t[2], t[1], middle});
    const auto why = validate(r.surface, result.mesh);
    if (!why.empty()) {
      result.ok = false;
      result.faults.push_back("star: " + why);
    }
    results.push_back(result);
  }
  return results;
}

inline MeshingOptions options_of(double element_size) {
  MeshingOptions options;
  options.element_size = element_size;
  options.meshers = {"star"};
  return options;
}

inline Mesh star_mesh(const Geometry& geometry, const MeshingOptions& options,
                      MeshingReport& report, const Vec3& scale = Vec3::Ones()) {
  return mesh_geometry(geometry, options, scale, at_once(star_meshes), report);
}

/// n^3 cubes of unit volume.
inline Geometry cubes(int n) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) seeds.push_back(Vec3(i, j, k) + Vec3::Constant(0.5));
  return geometry_of(voronoi_tessellation(seeds, Vec3::Constant(n)));
}

inline double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

/// Nodes of the flat domain faces lie on the box, bit for bit.
inline void expect_box(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int d = mesh.topology.faces[mesh.triangle_face[i]].domain_face;
    if (d < 0) continue;
    for (int n : mesh.triangles[i])
      if (n >= 0) {
        EXPECT_EQ(mesh.nodes[n][d / 2], d % 2 == 0 ? 0.0 : mesh.size[d / 2]);
      }
  }
}

/// Divergence-free motions: plane strain, and shears x_i += f(x_j) whose determinant is one.
inline Vec3 deformed(const Vec3& x0, double strain, double amplitude) {
  Vec3 x = x0;
  x[0] += amplitude * std::sin(1.9 * x[1] + 0.3) * std::sin(2.1 * x[2]);
  x[1] += amplitude * std::sin(2.3 * x[2] + 0.7) * std::cos(1.7 * x[0]);
  x[2] += amplitude * std::cos(2.0 * x[0] + 0.2) * std::sin(1.8 * x[1]);
  return x.cwiseProduct(Vec3(std::exp(strain), 1, std::exp(-strain)));
}

inline double largest_change(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] / b[i] - 1));
  return worst;
}

}  // namespace polyslip::mesh::test
