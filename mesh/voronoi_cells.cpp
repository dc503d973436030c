#include "mesh/voronoi_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <voro++/voro++.hh>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

int block_count(double length, double blocks_per_length) {
  return std::max(1, static_cast<int>(length * blocks_per_length));
}

SeparateCell read_cell(voro::voronoicell_neighbor& cell, const Vec3& seed) {
  SeparateCell result;
  std::vector<double> points;
  cell.vertices(seed.x(), seed.y(), seed.z(), points);
  for (std::size_t i = 0; i + 2 < points.size(); i += 3)
    result.vertices.emplace_back(points[i], points[i + 1], points[i + 2]);
  std::vector<int> neighbours, loops;
  cell.neighbors(neighbours);
  cell.face_vertices(loops);
  std::size_t at = 0;
  for (const int neighbour : neighbours) {
    const int n = loops[at++];
    SeparateFace face;
    face.neighbour = neighbour;
    face.loop.assign(loops.begin() + static_cast<long>(at),
                     loops.begin() + static_cast<long>(at) + n);
    at += static_cast<std::size_t>(n);
    result.faces.push_back(std::move(face));
  }
  return result;
}

void orient_outwards(SeparateCell& cell, const Vec3& seed) {
  double volume = 0;
  const auto& x = cell.vertices;
  for (const auto& face : cell.faces) {
    const Vec3 origin = x[face.loop[0]] - seed;
    for (std::size_t i = 1; i + 1 < face.loop.size(); ++i)
      volume += origin.dot((x[face.loop[i]] - seed).cross(x[face.loop[i + 1]] - seed));
  }
  if (volume > 0) return;
  for (auto& face : cell.faces) std::reverse(face.loop.begin(), face.loop.end());
}

}  // namespace

std::vector<SeparateCell> separate_voronoi_cells(const std::vector<Vec3>& seeds, const Vec3& size) {
  const double n = static_cast<double>(seeds.size());
  const double per_length = std::cbrt(n / (voro::optimal_particles * size.prod()));
  voro::container box(0, size.x(), 0, size.y(), 0, size.z(), block_count(size.x(), per_length),
                      block_count(size.y(), per_length), block_count(size.z(), per_length), false,
                      false, false, 8);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    box.put(static_cast<int>(i), seeds[i].x(), seeds[i].y(), seeds[i].z());

  std::vector<SeparateCell> cells(seeds.size());
  voro::c_loop_all loop(box);
  voro::voronoicell_neighbor cell;
  if (loop.start()) do {
      if (!box.compute_cell(cell, loop)) continue;
      const auto id = static_cast<std::size_t>(loop.pid());
      cells[id] = read_cell(cell, seeds[id]);
      orient_outwards(cells[id], seeds[id]);
    } while (loop.inc());
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].faces.size() < 4)
      throw core::InputError(
          fmt::format("seed {} at ({}, {}, {}) has no Voronoi cell: seeds must differ", i + 1,
                      seeds[i].x(), seeds[i].y(), seeds[i].z()));
  return cells;
}

}  // namespace polyslip::mesh
