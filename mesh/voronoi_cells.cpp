#include "mesh/voronoi_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

/// The seeds, then those of their translates that lie in the box [low, high].
struct SeedImages {
  std::vector<Vec3> seeds;
  std::vector<int> original;
  std::vector<Shift> shifts;
};

SeedImages images_of(const std::vector<Vec3>& seeds, const Domain& domain, const Vec3& margin) {
  SeedImages images;
  const auto add = [&](int seed, const Shift& shift) {
    images.seeds.push_back(translated(seeds[seed], shift, domain.size));
    images.original.push_back(seed);
    images.shifts.push_back(shift);
  };
  const int n = static_cast<int>(seeds.size());
  for (int i = 0; i < n; ++i) add(i, {0, 0, 0});
  std::array<int, 3> count{0, 0, 0};
  for (int k = 0; k < 3; ++k)
    if (domain.periodic[k]) count[k] = static_cast<int>(std::ceil(margin[k] / domain.size[k]));
  for (int i = 0; i < n; ++i)
    for (int x = -count[0]; x <= count[0]; ++x)
      for (int y = -count[1]; y <= count[1]; ++y)
        for (int z = -count[2]; z <= count[2]; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Vec3 image = translated(seeds[i], {x, y, z}, domain.size);
          if (((image + margin).array() >= 0).all() &&
              ((domain.size + margin - image).array() >= 0).all())
            add(i, {x, y, z});
        }
  return images;
}

/// Of the largest cell about its seed; infinite if one meets a wall in a periodic direction.
double cell_radius(const std::vector<SeparateCell>& cells, const std::vector<Vec3>& seeds,
                   const Domain& domain) {
  double radius = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const auto& face : cells[c].faces)
      if (face.neighbour < 0 && domain.periodic[wall_of_neighbour(face.neighbour) / 2])
        return std::numeric_limits<double>::infinity();
    for (const Vec3& x : cells[c].vertices) radius = std::max(radius, (x - seeds[c]).norm());
  }
  return radius;
}

void put(voro::container& box, int id, const Vec3& x, double) { box.put(id, x.x(), x.y(), x.z()); }
void put(voro::container_poly& box, int id, const Vec3& x, double radius) {
  box.put(id, x.x(), x.y(), x.z(), radius);
}

// Without faces: cells that are empty. `radii`: of the seeds, for a container that takes them.
template <class Container>
std::vector<SeparateCell> compute_cells(const std::vector<Vec3>& seeds,
                                        const std::vector<double>& radii, const Domain& domain,
                                        const Vec3& margin) {
  const SeedImages images = images_of(seeds, domain, margin);
  const Vec3 low = -margin, high = domain.size + margin;
  const auto blocks = block_counts(images.seeds, high - low);
  Container box(low.x(), high.x(), low.y(), high.y(), low.z(), high.z(), blocks[0], blocks[1],
                blocks[2], false, false, false, 8);
  for (std::size_t i = 0; i < images.seeds.size(); ++i)
    put(box, static_cast<int>(i), images.seeds[i],
        radii.empty() ? 0 : radii[static_cast<std::size_t>(images.original[i])]);
  std::vector<SeparateCell> cells(seeds.size());
  voro::c_loop_all loop(box);
  voro::voronoicell_neighbor cell;
  if (loop.start()) do {
      const auto id = static_cast<std::size_t>(loop.pid());
      if (id >= seeds.size() || !box.compute_cell(cell, loop)) continue;
      if (!domain.is_box() && !cut_by_planes(cell, seeds[id], domain)) continue;
      cells[id] = read_cell(cell, seeds[id]);
      orient_outwards(cells[id], seeds[id]);
      if (!domain.is_box()) name_planes(cells[id]);
    } while (loop.inc());
  for (auto& c : cells)
    for (auto& face : c.faces) {
      if (face.neighbour < 0) continue;
      face.shift = images.shifts[static_cast<std::size_t>(face.neighbour)];
      face.neighbour = images.original[static_cast<std::size_t>(face.neighbour)];
    }
  return cells;
}

/// A seed at a distance d from one with a cell of radius R cannot cut that if d > R + sqrt(R^2 +
/// w), w the largest difference of weights. So far reach the translates that count.
template <class Container>
std::vector<SeparateCell> cells_in(const std::vector<Vec3>& seeds, const std::vector<double>& radii,
                                   const Domain& domain) {
  // A domain that is no box lies well inside the library's box, whose walls its planes cut off.
  Vec3 margin = domain.is_box() ? Vec3(Vec3::Zero()) : Vec3(0.1 * domain.size);
  if (!domain.is_periodic()) return compute_cells<Container>(seeds, radii, domain, margin);
  const double largest = radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
  double wanted = 3 * std::cbrt(domain.volume / static_cast<double>(seeds.size()));
  for (;;) {
    for (int k = 0; k < 3; ++k)
      if (domain.periodic[k]) margin[k] = wanted;
    auto cells = compute_cells<Container>(seeds, radii, domain, margin);
    const double r = cell_radius(cells, seeds, domain);
    const double needed = r + std::hypot(r, largest);
    if (needed <= wanted) return cells;
    wanted = std::isinf(needed) ? 2 * wanted : 1.01 * needed;
  }
}

}  // namespace

std::vector<SeparateCell> separate_voronoi_cells(const std::vector<Vec3>& seeds,
                                                 const Domain& domain) {
  auto cells = cells_in<voro::container>(seeds, {}, domain);
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
  const double least = weights.empty() ? 0 : *std::min_element(weights.begin(), weights.end());
  std::vector<double> radii;
  for (const double w : weights) radii.push_back(std::sqrt(w - least));
  return cells_in<voro::container_poly>(seeds, radii, domain);
}

}  // namespace polyslip::mesh
