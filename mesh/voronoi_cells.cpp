#include "mesh/voronoi_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <voro++/voro++.hh>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// The library calls the walls of its box -1 to -6; planes of the domain come after them.
constexpr int library_walls = 6;

/// Blocks of the library's grid along each axis, for about `optimal_particles` seeds a block. Seeds
/// may lie in a plane or on a line.
std::array<int, 3> block_counts(const std::vector<Vec3>& seeds, const Vec3& size) {
  if (seeds.empty()) return {1, 1, 1};
  Vec3 low = seeds[0], high = seeds[0];
  for (const Vec3& x : seeds) low = low.cwiseMin(x), high = high.cwiseMax(x);
  double extent = 1;
  int dimensions = 0;
  std::array<bool, 3> spread{};
  for (int i = 0; i < 3; ++i) {
    spread[i] = high[i] - low[i] > 1e-6 * size[i];
    if (spread[i]) extent *= size[i], ++dimensions;
  }
  std::array<int, 3> counts{1, 1, 1};
  if (dimensions == 0) return counts;
  const double per_length = std::pow(
      static_cast<double>(seeds.size()) / (voro::optimal_particles * extent), 1.0 / dimensions);
  for (int i = 0; i < 3; ++i)
    if (spread[i]) counts[i] = std::max(1, static_cast<int>(size[i] * per_length));
  return counts;
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

void name_planes(SeparateCell& cell) {
  for (auto& face : cell.faces) {
    if (face.neighbour >= 0) continue;
    face.neighbour += library_walls;
    if (face.neighbour >= 0)
      throw core::InternalError("tessellation: a cell reaches beyond the domain's planes");
  }
}

// The planes of the domain that cut the cell. False if nothing of the cell is left.
bool cut_by_planes(voro::voronoicell_neighbor& cell, const Vec3& seed, const Domain& domain) {
  std::vector<double> x;
  cell.vertices(x);  // relative to the seed
  double reach = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3)
    reach = std::max(reach, x[i] * x[i] + x[i + 1] * x[i + 1] + x[i + 2] * x[i + 2]);
  reach = std::sqrt(reach);
  for (int f = 0; f < domain.face_count(); ++f) {
    const Vec3& n = domain.faces[f].plane.normal;
    const double distance = domain.faces[f].plane.offset - n.dot(seed);
    if (distance > reach) continue;
    double farthest = 0;
    for (std::size_t i = 0; i + 2 < x.size(); i += 3)
      farthest = std::max(farthest, n.x() * x[i] + n.y() * x[i + 1] + n.z() * x[i + 2]);
    if (farthest < distance) continue;
    // The plane's distance, doubled as the library wants it.
    if (!cell.nplane(n.x(), n.y(), n.z(), 2 * distance, wall_neighbour(f) - library_walls))
      return false;
    cell.vertices(x);
  }
  return true;
}

// The library's box, and how many blocks it is divided into along each axis.
template <class Container>
Container make_container(const std::vector<Vec3>& seeds, const Domain& domain) {
  // A domain that is no box lies well inside the library's box, whose walls its planes cut off.
  const Vec3& size = domain.size;
  const Vec3 margin = domain.is_box() ? Vec3(Vec3::Zero()) : Vec3(0.1 * size);
  const auto blocks = block_counts(seeds, size);
  const Vec3 low = -margin, high = size + margin;
  return Container(low.x(), high.x(), low.y(), high.y(), low.z(), high.z(), blocks[0], blocks[1],
                   blocks[2], false, false, false, 8);
}

// Without faces: cells that are empty.
template <class Container>
std::vector<SeparateCell> compute_cells(Container& box, const std::vector<Vec3>& seeds,
                                        const Domain& domain) {
  std::vector<SeparateCell> cells(seeds.size());
  voro::c_loop_all loop(box);
  voro::voronoicell_neighbor cell;
  if (loop.start()) do {
      if (!box.compute_cell(cell, loop)) continue;
      const auto id = static_cast<std::size_t>(loop.pid());
      if (!domain.is_box() && !cut_by_planes(cell, seeds[id], domain)) continue;
      cells[id] = read_cell(cell, seeds[id]);
      orient_outwards(cells[id], seeds[id]);
      if (!domain.is_box()) name_planes(cells[id]);
    } while (loop.inc());
  return cells;
}

}  // namespace

std::vector<SeparateCell> separate_voronoi_cells(const std::vector<Vec3>& seeds,
                                                 const Domain& domain) {
  auto box = make_container<voro::container>(seeds, domain);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    box.put(static_cast<int>(i), seeds[i].x(), seeds[i].y(), seeds[i].z());
  auto cells = compute_cells(box, seeds, domain);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].faces.size() < 4)
      throw core::InputError(
          fmt::format("seed {} at ({}, {}, {}) has no Voronoi cell: seeds must differ", i + 1,
                      seeds[i].x(), seeds[i].y(), seeds[i].z()));
  return cells;
}

std::vector<SeparateCell> separate_power_cells(const std::vector<Vec3>& seeds,
                                               const std::vector<double>& weights,
                                               const Domain& domain) {
  auto box = make_container<voro::container_poly>(seeds, domain);
  const double least = weights.empty() ? 0 : *std::min_element(weights.begin(), weights.end());
  for (std::size_t i = 0; i < seeds.size(); ++i)
    box.put(static_cast<int>(i), seeds[i].x(), seeds[i].y(), seeds[i].z(),
            std::sqrt(weights[i] - least));
  return compute_cells(box, seeds, domain);
}

}  // namespace polyslip::mesh
