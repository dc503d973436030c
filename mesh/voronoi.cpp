// The conforming tessellation of a convex domain: cells that were computed one by one are given
// shared vertices, edges and faces. A vertex is first known by the four cells and walls that meet
// there; where more than four meet (grids of seeds), vertices that coincide are merged.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "core/error.hpp"
#include "mesh/folded_tessellation.hpp"
#include "mesh/tessellation.hpp"
#include "mesh/voronoi_cells.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The lower id stays the root.
  void join(int i, int j) {
    i = root(i), j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

/// Vertices of all cells in one list; vertex i of cell c is number first[c] + i.
struct LocalVertices {
  std::vector<int> first;
  std::vector<Vec3> positions;
  std::vector<std::vector<int>> walls;  ///< faces of the domain at each
  /// The four cells and walls that meet at a vertex, ascending; all -7 if there are more.
  std::vector<std::array<int, 4>> keys;
};

constexpr std::array<int, 4> no_key{-7, -7, -7, -7};

LocalVertices collect(const std::vector<SeparateCell>& cells) {
  LocalVertices all;
  for (int c = 0; c < static_cast<int>(cells.size()); ++c) {
    const auto& cell = cells[c];
    all.first.push_back(static_cast<int>(all.positions.size()));
    std::vector<std::vector<int>> around(cell.vertices.size());
    for (const auto& face : cell.faces)
      for (const int v : face.loop) around[v].push_back(face.neighbour);
    for (std::size_t v = 0; v < cell.vertices.size(); ++v) {
      auto& key = around[v];
      std::vector<int> walls;
      for (const int neighbour : key)
        if (neighbour < 0) walls.push_back(wall_of_neighbour(neighbour));
      key.push_back(c);
      std::sort(key.begin(), key.end());
      all.positions.push_back(cell.vertices[v]);
      all.walls.push_back(std::move(walls));
      all.keys.push_back(key.size() == 4 ? std::array<int, 4>{key[0], key[1], key[2], key[3]}
                                         : no_key);
    }
  }
  return all;
}

/// Distances and places on the torus that the periodic directions of a domain make of space.
struct Torus {
  const Domain& domain;

  Shift nearest_shift(const Vec3& x) const {
    Shift shift{0, 0, 0};
    for (int k = 0; k < 3; ++k)
      if (domain.periodic[k]) shift[k] = static_cast<int>(std::lround(x[k] / domain.size[k]));
    return shift;
  }
  double distance(const Vec3& a, const Vec3& b) const {
    const Vec3 d = a - b;
    return translated(d, -nearest_shift(d), domain.size).norm();
  }
  /// The translate in [0, period).
  Vec3 wrapped(const Vec3& x) const {
    return translated(x, -nearest_shift(x - 0.5 * domain.size), domain.size);
  }
};

// Seeds that are almost a grid can give one key to vertices that lie apart, and so do the
// translates of few grains: those are not joined.
void join_equal_keys(const LocalVertices& all, double apart, const Torus& torus, UnionFind& sets) {
  std::vector<int> order(all.keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return all.keys[i] != all.keys[j] ? all.keys[i] < all.keys[j] : i < j;
  });
  const bool periodic = torus.domain.is_periodic();
  for (std::size_t i = 1; i < order.size(); ++i)
    for (std::size_t j = i;
         j-- > 0 && all.keys[order[i]] != no_key && all.keys[order[i]] == all.keys[order[j]];) {
      if (torus.distance(all.positions[order[i]], all.positions[order[j]]) < apart)
        sets.join(order[j], order[i]);
      if (!periodic) break;
    }
}

// Sweep along a direction in which the planes of a grid do not stack up.
void join_coincident(const LocalVertices& all, double tolerance, const Torus& torus,
                     UnionFind& sets) {
  const Vec3 direction = Vec3(0.5377, 0.6423, 0.5461).normalized();
  struct Item {
    double along;
    int id;
    Vec3 x;
  };
  std::vector<Item> items;
  const Domain& domain = torus.domain;
  for (int i = 0; i < static_cast<int>(all.positions.size()); ++i) {
    if (sets.root(i) != i) continue;
    // Near the low sides of the box the translates at the high sides count too.
    std::vector<Vec3> places{torus.wrapped(all.positions[i])};
    for (int k = 0; k < 3; ++k)
      if (domain.periodic[k] && places.front()[k] <= tolerance)
        for (std::size_t p = 0, n = places.size(); p < n; ++p)
          places.push_back(places[p] + domain.size[k] * Vec3::Unit(k));
    for (const Vec3& x : places) items.push_back({direction.dot(x), i, x});
  }
  std::sort(items.begin(), items.end(), [](const Item& p, const Item& q) {
    return p.along != q.along ? p.along < q.along : p.id < q.id;
  });
  for (std::size_t i = 0; i < items.size(); ++i)
    for (std::size_t j = i + 1; j < items.size() && items[j].along - items[i].along <= tolerance;
         ++j)
      if ((items[i].x - items[j].x).norm() <= tolerance) sets.join(items[i].id, items[j].id);
}

/// A vertex of a loop: where it is, its position + shift * periods.
struct Corner {
  int vertex = -1;
  Shift shift{0, 0, 0};
  bool operator==(const Corner&) const = default;
};
using Loop = std::vector<Corner>;

void drop_repeated(Loop& loop) {
  Loop kept;
  for (const Corner& v : loop)
    if (kept.empty() || kept.back() != v) kept.push_back(v);
  while (kept.size() > 1 && kept.front() == kept.back()) kept.pop_back();
  loop = std::move(kept);
}

/// Whether q, moved by `shift`, is p backwards.
bool same_loop_reversed(const Loop& p, Loop q, const Shift& shift) {
  if (p.size() != q.size()) return false;
  for (Corner& corner : q) corner.shift = corner.shift + shift;
  std::reverse(q.begin(), q.end());
  const auto start = std::find(q.begin(), q.end(), p.front());
  std::rotate(q.begin(), start, q.end());
  return p == q;
}

struct EdgeKey {
  std::array<int, 2> vertices;
  Shift shift;
  bool operator==(const EdgeKey&) const = default;
  struct Hash {
    std::size_t operator()(const EdgeKey& key) const {
      std::uint64_t h = static_cast<std::uint64_t>(key.vertices[0]) << 32U |
                        static_cast<std::uint32_t>(key.vertices[1]);
      for (const int s : key.shift) h = 0x9E3779B97F4A7C15U * (h ^ static_cast<unsigned>(s));
      return h;
    }
  };
};

class Assembly {
 public:
  Assembly(const std::vector<SeparateCell>& cells, const std::vector<Vec3>& seeds,
           const std::vector<double>& weights, const Domain& domain)
      : cells_(cells), all_(collect(cells)) {
    folded_.seeds = seeds;
    folded_.weights = weights;
    folded_.domain = domain;
  }

  /// Empty if cells do not agree on the faces between them: the tolerance was too small.
  std::optional<Tessellation> build(double tolerance) {
    folded_.vertices.clear();
    folded_.edges.clear();
    folded_.faces.clear();
    folded_.cell_faces.assign(cells_.size(), {});
    edge_ids_.clear();
    number_vertices(tolerance);
    map_loops();
    for (int c = 0; c < static_cast<int>(cells_.size()); ++c)
      for (std::size_t i = 0; i < cells_[c].faces.size(); ++i)
        if (!add_face(c, i)) return std::nullopt;
    Tessellation result = unfold(folded_);
    try {
      result.topology.check(result.domain.face_count());
    } catch (const core::InternalError&) {
      return std::nullopt;
    }
    return result;
  }

 private:
  void number_vertices(double tolerance) {
    const auto n = all_.positions.size();
    const Torus torus{folded_.domain};
    UnionFind sets(n);
    join_equal_keys(all_, 1e6 * tolerance, torus, sets);
    join_coincident(all_, tolerance, torus, sets);
    corners_.assign(n, {});
    std::vector<std::array<int, 2>> walls;
    for (int i = 0; i < static_cast<int>(n); ++i) {
      const int root = sets.root(i);
      if (root == i) {
        corners_[i].vertex = static_cast<int>(folded_.vertices.size());
        folded_.vertices.push_back(clamped(all_.positions[i]));
      }
      const int vertex = corners_[root].vertex;
      corners_[i] = {vertex, torus.nearest_shift(all_.positions[i] - folded_.vertices[vertex])};
      for (const int w : all_.walls[i]) walls.push_back({vertex, w});
    }
    snap({folded_.vertices.size(), std::move(walls)});
  }

  Vec3 clamped(Vec3 x) const {
    for (int k = 0; k < 3; ++k)
      if (!folded_.domain.periodic[k]) x[k] = std::clamp(x[k], 0.0, folded_.domain.size[k]);
    return x;
  }

  void snap(const DomainFaceLists& walls) {
    std::vector<Plane> planes;
    for (std::size_t v = 0; v < folded_.vertices.size(); ++v) {
      planes.clear();
      for (const int w : walls[v]) planes.push_back(folded_.domain.faces[w].plane);
      if (!planes.empty()) put_on_planes(planes, folded_.vertices[v]);
    }
  }

  void map_loops() {
    loops_.assign(cells_.size(), {});
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (const auto& face : cells_[c].faces) {
        Loop loop;
        for (const int v : face.loop) loop.push_back(corners_[all_.first[c] + v]);
        drop_repeated(loop);
        if (loop.size() < 3) loop.clear();
        loops_[c].push_back(std::move(loop));
      }
  }

  const Loop& loop_between(int cell, int neighbour, const Shift& shift) const {
    static const Loop none;
    const auto& faces = cells_[cell].faces;
    for (std::size_t i = 0; i < faces.size(); ++i)
      if (faces[i].neighbour == neighbour && faces[i].shift == shift) return loops_[cell][i];
    return none;
  }

  bool add_face(int cell, std::size_t i) {
    const Loop& loop = loops_[cell][i];
    if (loop.empty()) return true;
    const auto& [neighbour, shift, vertices] = cells_[cell].faces[i];
    if (neighbour >= 0) {
      if (!same_loop_reversed(loop, loop_between(neighbour, cell, -shift), shift)) return false;
      // Was it added from the other side?
      if (neighbour < cell || (neighbour == cell && shift < Shift{0, 0, 0})) return true;
    }
    const int id = static_cast<int>(folded_.faces.size());
    FoldedTessellation::Face face;
    face.cells = {cell, std::max(neighbour, -1)};
    face.start = loop.front().shift;
    face.step = -shift;
    if (neighbour < 0) face.domain_face = wall_of_neighbour(neighbour);
    for (std::size_t k = 0; k < loop.size(); ++k)
      add_side(loop[k], loop[(k + 1) % loop.size()], face);
    face.plane = plane_between(cell, neighbour, shift);
    folded_.faces.push_back(std::move(face));
    folded_.cell_faces[cell].push_back(id);
    if (neighbour >= 0 && neighbour != cell) folded_.cell_faces[neighbour].push_back(id);
    return true;
  }

  void add_side(const Corner& from, const Corner& to, FoldedTessellation::Face& face) {
    const Shift along = to.shift - from.shift;
    const bool up = from.vertex != to.vertex ? from.vertex < to.vertex : Shift{0, 0, 0} < along;
    const EdgeKey key =
        up ? EdgeKey{{from.vertex, to.vertex}, along} : EdgeKey{{to.vertex, from.vertex}, -along};
    const auto [at, added] = edge_ids_.try_emplace(key, folded_.edges.size());
    if (added) folded_.edges.push_back({{from.vertex, to.vertex}, along});
    const auto& edge = folded_.edges[at->second];
    face.edges.push_back(at->second);
    face.forward.push_back(edge.vertices[0] == from.vertex && edge.shift == along);
  }

  Plane plane_between(int cell, int neighbour, const Shift& shift) const {
    if (neighbour < 0) return folded_.domain.faces[wall_of_neighbour(neighbour)].plane;
    Plane plane;
    const Vec3& p = folded_.seeds[cell];
    const Vec3 q = translated(folded_.seeds[neighbour], shift, folded_.domain.size);
    plane.normal = (q - p).normalized();
    plane.offset = plane.normal.dot(0.5 * (p + q));
    if (!folded_.weights.empty())
      plane.offset += (folded_.weights[cell] - folded_.weights[neighbour]) / (2 * (q - p).norm());
    return plane;
  }

  const std::vector<SeparateCell>& cells_;
  LocalVertices all_;
  FoldedTessellation folded_;
  std::vector<Corner> corners_;  ///< of the local vertices
  std::vector<std::vector<Loop>> loops_;
  std::unordered_map<EdgeKey, int, EdgeKey::Hash> edge_ids_;
};

// No weights: a Voronoi tessellation.
std::optional<Tessellation> assemble(const std::vector<Vec3>& seeds,
                                     const std::vector<double>& weights, const Domain& domain) {
  const auto cells = weights.empty() ? separate_voronoi_cells(seeds, domain)
                                     : separate_power_cells(seeds, weights, domain);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].faces.size() < 4)
      throw core::InputError(
          fmt::format("seed {} at ({}, {}, {}) of weight {} has no Laguerre cell: the cells of "
                      "heavier seeds cover it",
                      i + 1, seeds[i].x(), seeds[i].y(), seeds[i].z(), weights[i]));
  const double cell_size = std::cbrt(domain.volume / static_cast<double>(seeds.size()));
  Assembly assembly(cells, seeds, weights, domain);
  for (double tolerance : {1e-10, 1e-9, 1e-8, 1e-7})
    if (auto result = assembly.build(tolerance * cell_size)) return result;
  return std::nullopt;
}

void check_inside(const std::vector<Vec3>& seeds, const Domain& domain) {
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (!domain.contains(seeds[i]))
      throw core::InputError(
          fmt::format("seed {} at ({}, {}, {}) lies outside the {} [{}, {}, {}]: move it inside",
                      i + 1, seeds[i].x(), seeds[i].y(), seeds[i].z(), domain.shape,
                      domain.size.x(), domain.size.y(), domain.size.z()));
}

}  // namespace

Tessellation voronoi_tessellation(const std::vector<Vec3>& seeds, const Domain& domain) {
  if (seeds.empty()) throw core::InputError("a tessellation needs at least one seed");
  check_inside(seeds, domain);
  if (auto result = assemble(seeds, {}, domain)) return std::move(*result);
  // Seeds that miss a grid by about the rounding of the cells (1e-11): put them on one.
  auto rounded = seeds;
  const double step = 0x1.0p-27;
  for (Vec3& x : rounded) {
    for (double& xi : x) xi = std::round(xi / step) * step;
    x = x.cwiseMin(domain.size);
  }
  if (auto result = assemble(rounded, {}, domain)) return std::move(*result);
  throw core::InternalError("tessellation: neighbouring cells disagree on the face between them");
}

Tessellation laguerre_tessellation(const std::vector<Vec3>& seeds,
                                   const std::vector<double>& weights, const Domain& domain) {
  if (seeds.empty() || weights.size() != seeds.size())
    throw core::InputError(fmt::format(
        "a Laguerre tessellation needs seeds and a weight for each: {} seeds, {} weights",
        seeds.size(), weights.size()));
  check_inside(seeds, domain);
  if (auto result = assemble(seeds, weights, domain)) return std::move(*result);
  throw core::InternalError("tessellation: neighbouring cells disagree on the face between them");
}

Tessellation voronoi_tessellation(const std::vector<Vec3>& seeds, const Vec3& size) {
  if (seeds.empty()) throw core::InputError("a tessellation needs at least one seed");
  return voronoi_tessellation(seeds, box_domain(size));
}

}  // namespace polyslip::mesh
