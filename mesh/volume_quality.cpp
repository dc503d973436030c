#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/quality_criterion.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {
namespace {

/// Facets of a positive tetrahedron, normals outward.
constexpr std::array<std::array<int, 3>, 4> outward_facets{
    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

/// A triangle by its sorted nodes, and whether sorting took an even number of swaps.
struct Facet {
  std::array<int, 3> nodes;
  bool even;
  bool operator<(const Facet& other) const {
    return nodes != other.nodes ? nodes < other.nodes : even < other.even;
  }
  bool operator==(const Facet& other) const { return nodes == other.nodes && even == other.even; }
};

Facet make_facet(int a, int b, int c) {
  bool even = true;
  const auto order = [&even](int& x, int& y) {
    if (x > y) {
      std::swap(x, y);
      even = !even;
    }
  };
  order(a, b);
  order(b, c);
  order(a, b);
  return {{a, b, c}, even};
}

double six_volumes(const VolumeMesh& mesh, const std::array<int, 4>& t) {
  const core::Vec3& a = mesh.nodes[t[0]];
  return (mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).dot(mesh.nodes[t[3]] - a);
}

std::string check_nodes(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  if (surface.nodes.empty() || surface.triangles.empty()) return "the surface is empty";
  if (mesh.tetrahedra.empty()) return "no tetrahedra";
  if (mesh.nodes.size() < surface.nodes.size()) return "surface nodes are missing";
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
    if (!surface.nodes[i].allFinite()) return fmt::format("surface node {} is not finite", i);
    if (std::memcmp(surface.nodes[i].data(), mesh.nodes[i].data(), 3 * sizeof(double)) != 0)
      return fmt::format("surface node {} has moved", i);
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (!mesh.nodes[i].allFinite()) return fmt::format("node {} is not finite", i);
  std::vector<bool> used(mesh.nodes.size(), false);
  for (const auto& t : mesh.tetrahedra)
    for (const int n : t) {
      if (n < 0 || n >= static_cast<int>(mesh.nodes.size()))
        return fmt::format("a tetrahedron has node {} of {}", n, mesh.nodes.size());
      used[n] = true;
    }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end()) return fmt::format("node {} is unused", unused - used.begin());
  return {};
}

std::string check_facets(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  std::vector<Facet> inside, outside;
  inside.reserve(4 * mesh.tetrahedra.size());
  for (const auto& t : mesh.tetrahedra)
    for (const auto& f : outward_facets) inside.push_back(make_facet(t[f[0]], t[f[1]], t[f[2]]));
  std::sort(inside.begin(), inside.end());
  for (std::size_t i = 0; i < inside.size();) {
    if (i + 1 < inside.size() && inside[i].nodes == inside[i + 1].nodes) {
      if (inside[i].even == inside[i + 1].even) return "two tetrahedra on one side of a facet";
      i += 2;
      if (i < inside.size() && inside[i].nodes == inside[i - 1].nodes)
        return "a facet has more than two tetrahedra";
    } else {
      outside.push_back(inside[i++]);
    }
  }
  std::vector<Facet> wanted;
  wanted.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles) wanted.push_back(make_facet(t[0], t[1], t[2]));
  std::sort(wanted.begin(), wanted.end());
  if (outside != wanted) {
    std::vector<Facet> kept;
    std::set_intersection(wanted.begin(), wanted.end(), outside.begin(), outside.end(),
                          std::back_inserter(kept));
    return fmt::format("the surface is not kept: {} of {} triangles among {} boundary facets",
                       kept.size(), wanted.size(), outside.size());
  }
  return {};
}

std::string check_volumes(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    const double v = six_volumes(mesh, mesh.tetrahedra[i]);
    if (!(v > 0)) return fmt::format("tetrahedron {} has volume {:.3g}", i, v / 6);
    sum += v;
  }
  double enclosed = 0;
  const core::Vec3& origin = surface.nodes.front();
  for (const auto& t : surface.triangles)
    enclosed += (surface.nodes[t[0]] - origin)
                    .cross(surface.nodes[t[1]] - origin)
                    .dot(surface.nodes[t[2]] - origin);
  if (!(std::abs(sum - enclosed) <= 1e-10 * std::abs(enclosed)))
    return fmt::format("volume {:.15g} inside a surface that encloses {:.15g}", sum / 6,
                       enclosed / 6);
  return {};
}

}  // namespace

std::string validate(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  std::string fault = check_nodes(surface, mesh);
  if (fault.empty()) fault = check_facets(surface, mesh);
  if (fault.empty()) fault = check_volumes(surface, mesh);
  return fault;
}

double min_radius_ratio(const VolumeMesh& mesh) {
  double least = mesh.tetrahedra.empty() ? 0 : 1;
  for (const auto& t : mesh.tetrahedra) {
    const double rho =
        radius_ratio(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]);
    if (std::isnan(rho)) return rho;
    least = std::min(least, rho);
  }
  return least;
}

double mesh_quality_O(const VolumeMesh& mesh, double element_size) {
  QualityCriterion criterion(element_size);
  for (const auto& t : mesh.tetrahedra) {
    const std::array<const core::Vec3*, 4> x{&mesh.nodes[t[0]], &mesh.nodes[t[1]],
                                             &mesh.nodes[t[2]], &mesh.nodes[t[3]]};
    double length = 0;
    for (const auto& edge : tetrahedron_edges) length += (*x[edge[0]] - *x[edge[1]]).norm() / 6;
    criterion.add(radius_ratio(*x[0], *x[1], *x[2], *x[3]), length);
  }
  return criterion.value();
}

}  // namespace polyslip::mesh
