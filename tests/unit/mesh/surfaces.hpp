#pragma once
// Closed surfaces to mesh.

#include <map>
#include <set>
#include <vector>

#include "mesh/pipeline.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh::test {

/// Boundary of a set of cells of a cubic grid of step h, each square cut in two.
inline SurfaceMesh voxel_surface(const std::set<std::array<int, 3>>& cells, double h) {
  SurfaceMesh surface;
  std::map<std::array<int, 3>, int> number;
  const auto node = [&](const std::array<int, 3>& p) {
    const auto [place, fresh] = number.try_emplace(p, static_cast<int>(surface.nodes.size()));
    if (fresh) surface.nodes.emplace_back(h * p[0], h * p[1], h * p[2]);
    return place->second;
  };
  for (const auto& cell : cells)
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        auto neighbour = cell;
        neighbour[axis] += 2 * side - 1;
        if (cells.count(neighbour)) continue;
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        std::array<std::array<int, 3>, 4> p{cell, cell, cell, cell};
        for (auto& corner : p) corner[axis] += side;
        ++p[1][b], ++p[2][b], ++p[2][c], ++p[3][c];
        std::array<int, 4> n{node(p[0]), node(p[1]), node(p[2]), node(p[3])};
        if (side == 0) std::swap(n[1], n[3]);
        surface.triangles.push_back({n[0], n[1], n[2]});
        surface.triangles.push_back({n[0], n[2], n[3]});
      }
  return surface;
}

/// Meshers that take all requests at once.
inline GrainMeshers at_once(
    const std::function<std::vector<GrainResult>(const std::vector<GrainRequest>&)>& meshers) {
  return [meshers](std::size_t count, const RequestSource& source, const ResultSink& sink) {
    std::vector<GrainRequest> requests;
    for (std::size_t i = 0; i < count; ++i) requests.push_back(source(i));
    auto results = meshers(requests);
    // Results may come in any order.
    for (std::size_t i = results.size(); i-- > 0;) sink(i, std::move(results[i]));
  };
}

inline SurfaceMesh cube_surface(int n, double size) {
  std::set<std::array<int, 3>> cells;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) cells.insert({i, j, k});
  return voxel_surface(cells, size / n);
}

/// A cube of 2n cells a side without one of its octants.
inline SurfaceMesh notched_surface(int n, double size) {
  std::set<std::array<int, 3>> cells;
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < 2 * n; ++j)
      for (int k = 0; k < 2 * n; ++k)
        if (i < n || j < n || k < n) cells.insert({i, j, k});
  return voxel_surface(cells, size / (2 * n));
}

/// Octahedron refined `levels` times, on the unit sphere scaled along the axes.
inline SurfaceMesh ellipsoid_surface(int levels, const core::Vec3& radii) {
  SurfaceMesh s;
  s.nodes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto [place, fresh] = middles.try_emplace(key, static_cast<int>(s.nodes.size()));
      if (fresh) s.nodes.push_back((s.nodes[a] + s.nodes[b]).normalized());
      return place->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& t : s.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.push_back({t[0], a, c});
      finer.push_back({t[1], b, a});
      finer.push_back({t[2], c, b});
      finer.push_back({a, b, c});
    }
    s.triangles = std::move(finer);
  }
  for (auto& x : s.nodes) x = x.cwiseProduct(radii);
  return s;
}

}  // namespace polyslip::mesh::test
