#include "mesh/volume_correction.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// A mid node moves by no more than this part of the root of the area that its face moves.
constexpr double largest_move = 0.02;

/// 1/3 of the integral of x . n over a six-node triangle (degree 4), by Gauss's three points a
/// direction on the square that collapses to the triangle.
double flux(const std::array<Vec3, 6>& x) {
  const std::array<double, 3> at{(1 - std::sqrt(0.6)) / 2, 0.5, (1 + std::sqrt(0.6)) / 2};
  const std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double xi = at[i], eta = at[j] * (1 - at[i]);
      const auto n = tri6_shape(xi, eta);
      const auto g = tri6_gradients(xi, eta);
      Vec3 p = Vec3::Zero(), d1 = Vec3::Zero(), d2 = Vec3::Zero();
      for (int k = 0; k < 6; ++k) {
        p += n[k] * x[k];
        d1 += g[k][0] * x[k];
        d2 += g[k][1] * x[k];
      }
      sum += weight[i] * weight[j] * (1 - xi) * p.dot(d1.cross(d2));
    }
  return sum / 3;
}

/// Where mid nodes inside faces go, and the area that goes with them.
struct Motion {
  std::vector<Vec3> direction;  ///< [nodes] unit normal of the surface, zero for what stays
  std::vector<double> area;     ///< [faces] a_f
};

Motion motion_of(const Mesh& mesh, const std::vector<char>& fixed) {
  Motion motion{std::vector<Vec3>(mesh.nodes.size(), Vec3::Zero()),
                std::vector<double>(mesh.topology.faces.size(), 0.0)};
  std::vector<char> on_edge(mesh.nodes.size(), false);
  for (const auto& line : mesh.lines) on_edge[line[2]] = true;
  const auto area = [&](const std::array<int, 6>& t) -> Vec3 {
    const Vec3& origin = mesh.nodes[t[0]];
    return (mesh.nodes[t[1]] - origin).cross(mesh.nodes[t[2]] - origin) / 2;
  };
  const auto moves = [&](std::size_t i, int node) {
    return !fixed[mesh.triangle_face[i]] && !on_edge[node];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 3; k < 6; ++k)
      if (moves(i, mesh.triangles[i][k]))
        motion.direction[mesh.triangles[i][k]] += area(mesh.triangles[i]);
  for (auto& d : motion.direction)
    if (d.norm() > 0) d.normalize();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 3; k < 6; ++k)
      motion.area[mesh.triangle_face[i]] +=
          area(mesh.triangles[i]).dot(motion.direction[mesh.triangles[i][k]]) / 3;
  return motion;
}

/// l of every grain.
Eigen::VectorXd solve(const Topology& topology, const std::vector<double>& area,
                      const Eigen::VectorXd& missing) {
  const int n = topology.cell_count();
  std::vector<Eigen::Triplet<double>> entries;
  double total = 0;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const auto [g, h] = topology.faces[f].cells;
    entries.emplace_back(g, g, area[f]);
    total += area[f];
    if (h < 0) continue;
    entries.emplace_back(h, h, area[f]);
    entries.emplace_back(g, h, -area[f]);
    entries.emplace_back(h, g, -area[f]);
  }
  // Where no face of the domain moves, the sum of the volumes is given and l is free by a constant.
  for (int g = 0; g < n; ++g) entries.emplace_back(g, g, 1e-9 * total / n);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(missing);
}

}  // namespace

std::vector<double> grain_volumes(const Geometry& geometry) {
  const auto& topology = geometry.topology;
  std::vector<double> volumes(topology.cell_count(), 0.0);
  const Vec3 origin = geometry.size / 2;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    double sum = 0;
    for (const auto& t : geometry.faces[f].triangles) {
      std::array<Vec3, 6> x;
      for (int k = 0; k < 6; ++k) x[k] = geometry.faces[f].points[t[k]] - origin;
      sum += flux(x);
    }
    const auto [g, h] = topology.faces[f].cells;
    volumes[g] += sum;
    if (h >= 0) volumes[h] -= sum;
  }
  return volumes;
}

double correct_volumes(Mesh& mesh, const std::vector<double>& wanted,
                       const std::vector<char>& fixed) {
  const auto volumes = grain_volumes(mesh);
  Eigen::VectorXd missing(mesh.topology.cell_count());
  for (int g = 0; g < missing.size(); ++g) missing[g] = wanted[g] - volumes[g];
  const Motion motion = motion_of(mesh, fixed);
  const Eigen::VectorXd l = solve(mesh.topology, motion.area, missing);
  if (!l.allFinite()) return 0;
  double largest = 0;
  std::vector<char> moved(mesh.nodes.size(), false);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int f = mesh.triangle_face[i];
    if (!(motion.area[f] > 0)) continue;
    const auto [g, h] = mesh.topology.faces[f].cells;
    const double limit = largest_move * std::sqrt(motion.area[f]);
    const double d = std::clamp(h >= 0 ? l[g] - l[h] : l[g], -limit, limit);
    largest = std::max(largest, std::abs(d));
    for (int k = 3; k < 6; ++k) {
      const int node = mesh.triangles[i][k];
      if (!moved[node]) mesh.nodes[node] += d * motion.direction[node];
      moved[node] = true;
    }
  }
  return largest;
}

}  // namespace polyslip::mesh
