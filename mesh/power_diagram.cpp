#include "mesh/power_diagram.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace polyslip::mesh {
namespace {

using core::Mat3;
using core::Vec3;

/// Vertices whose three planes are closer to dependent than this (a determinant of unit normals)
/// are left out of derivatives: there more than three facets nearly meet along a line.
constexpr double least_determinant = 1e-8;

PowerFacet measure_facet(const SeparateFace& face, const std::vector<Vec3>& x, PowerCell& cell) {
  PowerFacet facet;
  facet.neighbour = face.neighbour;
  const auto& loop = face.loop;
  const Vec3& origin = x[loop[0]];
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    area += 0.5 * (x[loop[i]] - origin).cross(x[loop[i + 1]] - origin);
  facet.area = area.norm();
  facet.centroid = origin;
  if (!(facet.area > 0)) return facet;
  const Vec3 normal = area / facet.area;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec3 a = x[loop[i]] - origin, b = x[loop[i + 1]] - origin;
    moment += 0.5 * a.cross(b).dot(normal) * (a + b) / 3;
  }
  facet.centroid += moment / facet.area;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3& next = x[loop[(i + 1) % loop.size()]];
    const Vec3& before = x[loop[(i + loop.size() - 1) % loop.size()]];
    cell.vertices[loop[i]].surface_gradient += 0.5 * (next - before).cross(normal);
  }
  return facet;
}

void meet(PowerVertex& vertex, int facet) {
  for (int& f : vertex.facets)
    if (f < 0) {
      f = facet;
      return;
    }
}

PowerCell measure_cell(const SeparateCell& separate, const Vec3& seed) {
  PowerCell cell;
  cell.vertices.resize(separate.vertices.size());
  for (std::size_t v = 0; v < cell.vertices.size(); ++v)
    cell.vertices[v].position = separate.vertices[v];
  const auto& x = separate.vertices;
  Vec3 moment = Vec3::Zero();
  for (const auto& face : separate.faces) {
    const int number = static_cast<int>(cell.facets.size());
    cell.facets.push_back(measure_facet(face, x, cell));
    cell.surface += cell.facets.back().area;
    for (const int v : face.loop) meet(cell.vertices[v], number);
    const Vec3 a = x[face.loop[0]] - seed;
    for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
      const Vec3 b = x[face.loop[i]] - seed, c = x[face.loop[i + 1]] - seed;
      const double part = a.dot(b.cross(c)) / 6;
      cell.volume += part;
      moment += part * (a + b + c) / 4;
    }
  }
  if (cell.volume > 0) cell.centroid = seed + moment / cell.volume;
  return cell;
}

}  // namespace

double PowerCell::sphericity() const {
  if (!(volume > 0 && surface > 0)) return 0;
  return std::cbrt(std::numbers::pi * 36 * volume * volume) / surface;
}

std::vector<PowerCell> power_cells(const PowerSeeds& seeds, const Domain& domain) {
  const auto separate = separate_power_cells(seeds.positions, seeds.weights, domain);
  std::vector<PowerCell> cells;
  cells.reserve(separate.size());
  for (std::size_t i = 0; i < separate.size(); ++i)
    cells.push_back(measure_cell(separate[i], seeds.positions[i]));
  return cells;
}

PowerGradient surface_gradient(const std::vector<PowerCell>& cells, const PowerSeeds& seeds,
                               const Domain& domain, const std::vector<double>& g) {
  const auto& x = seeds.positions;
  PowerGradient gradient{std::vector<double>(3 * x.size(), 0), std::vector<double>(x.size(), 0)};
  const auto add = [&gradient](std::size_t seed, const Vec3& position, double weight) {
    for (int k = 0; k < 3; ++k) gradient.positions[3 * seed + k] += position[k];
    gradient.weights[seed] += weight;
  };
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const auto& vertex : cells[i].vertices) {
      if (vertex.facets[2] < 0) continue;
      Mat3 normals;
      Vec3 lengths = Vec3::Ones();
      std::array<int, 3> neighbours{};
      for (int k = 0; k < 3; ++k) {
        const int j = neighbours[k] = cells[i].facets[vertex.facets[k]].neighbour;
        const Vec3 normal =
            j >= 0 ? Vec3(x[j] - x[i]) : domain.faces[wall_of_neighbour(j)].plane.normal;
        lengths[k] = normal.norm();
        normals.row(k) = normal.transpose() / lengths[k];
      }
      if (!(std::abs(normals.determinant()) > least_determinant)) continue;
      const Vec3 part = normals.transpose()
                            .partialPivLu()
                            .solve(Vec3(g[i] * vertex.surface_gradient))
                            .cwiseQuotient(lengths);
      for (int k = 0; k < 3; ++k) {
        const int j = neighbours[k];
        if (j < 0) continue;
        add(i, part[k] * (vertex.position - x[i]), part[k] / 2);
        add(j, -part[k] * (vertex.position - x[j]), -part[k] / 2);
      }
    }
  return gradient;
}

std::vector<double> volume_gradient(const std::vector<PowerCell>& cells, const PowerSeeds& seeds,
                                    const std::vector<double>& g) {
  const auto& x = seeds.positions;
  std::vector<double> gradient(3 * x.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const auto& facet : cells[i].facets) {
      const int j = facet.neighbour;
      if (j < 0) continue;
      const double part = g[i] * facet.area / (x[j] - x[i]).norm();
      for (int k = 0; k < 3; ++k) {
        gradient[3 * i + k] += part * (facet.centroid[k] - x[i][k]);
        gradient[3 * j + k] -= part * (facet.centroid[k] - x[j][k]);
      }
    }
  return gradient;
}

}  // namespace polyslip::mesh
