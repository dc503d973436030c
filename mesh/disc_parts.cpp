#include "mesh/disc_parts.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// A triangle beyond a side, and the length of that side.
struct Neighbour {
  int triangle;
  double side;
};

class Cutter {
 public:
  Cutter(const TriangleSurface& surface, const std::vector<Vec3>& nodes)
      : surface_(surface),
        nodes_(nodes),
        neighbours_(surface.triangles.size()),
        part_(surface.triangles.size(), 0) {
    for (const auto& [a, b] : surface.joints) {
      const double length = common_side(a, b);
      neighbours_[a].push_back({b, length});
      neighbours_[b].push_back({a, length});
    }
  }

  std::vector<int> run(const FitPart& fit) {
    constexpr std::size_t few = 8;
    std::vector<int> all(surface_.triangles.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    auto open = pieces(all);
    while (!open.empty()) {
      const std::vector<int> triangles = std::move(open.back());
      open.pop_back();
      if (is_disc(triangles) && (triangles.size() <= few || fit(triangles))) continue;
      for (auto& piece : halves(triangles)) open.push_back(std::move(piece));
    }
    return numbered();
  }

 private:
  using Side = std::pair<int, int>;

  std::array<Side, 3> sides(int t) const {
    const auto& n = surface_.triangles[t];
    return {{{n[0], n[1]}, {n[1], n[2]}, {n[2], n[0]}}};
  }

  double common_side(int a, int b) const {
    for (const auto& [i, j] : sides(a))
      for (const auto& [k, l] : sides(b))
        if (i == l && j == k) return (nodes_[i] - nodes_[j]).norm();
    throw core::InternalError("disc_parts: two joined triangles have no common side");
  }

  Vec3 middle(int t) const {
    const auto& n = surface_.triangles[t];
    return (nodes_[n[0]] + nodes_[n[1]] + nodes_[n[2]]) / 3;
  }

  /// Whether a connected part is a disc.
  bool is_disc(const std::vector<int>& triangles) const {
    std::vector<int> corners;
    std::map<int, int> next;  // along the boundary
    std::size_t inner = 0, outer = 0;
    for (const int t : triangles) {
      corners.insert(corners.end(), surface_.triangles[t].begin(), surface_.triangles[t].end());
      for (const auto& side : sides(t)) {
        if (goes_on(t, side)) {
          ++inner;
          continue;
        }
        ++outer;
        if (!next.insert({side.first, side.second}).second) return false;
      }
    }
    std::sort(corners.begin(), corners.end());
    const auto v = std::unique(corners.begin(), corners.end()) - corners.begin();
    const auto e = static_cast<long>(inner / 2 + outer), f = static_cast<long>(triangles.size());
    if (outer == 0 || v - e + f != 1) return false;
    std::size_t length = 0;
    int node = next.begin()->first;
    do {
      const auto to = next.find(node);
      if (to == next.end()) return false;
      node = to->second;
      ++length;
    } while (node != next.begin()->first && length <= outer);
    return length == outer;
  }

  bool goes_on(int t, const Side& side) const {
    for (const Neighbour& n : neighbours_[t]) {
      if (part_[n.triangle] != part_[t]) continue;
      for (const auto& [i, j] : sides(n.triangle))
        if (i == side.second && j == side.first) return true;
    }
    return false;
  }

  /// Distance of each triangle of a part from one of them along its triangles' middles.
  std::vector<double> distances(int from) const {
    std::vector<double> d(part_.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.push({d[from] = 0, from});
    while (!queue.empty()) {
      const auto [length, t] = queue.top();
      queue.pop();
      if (length > d[t]) continue;
      for (const Neighbour& n : neighbours_[t]) {
        const double to = length + (middle(t) - middle(n.triangle)).norm();
        if (part_[n.triangle] != part_[t] || !(to < d[n.triangle])) continue;
        queue.push({d[n.triangle] = to, n.triangle});
      }
    }
    return d;
  }

  int farthest(const std::vector<int>& triangles, const std::vector<double>& d) const {
    return *std::max_element(triangles.begin(), triangles.end(),
                             [&](int a, int b) { return d[a] < d[b]; });
  }

  /// The connected pieces of both halves, with part numbers of their own.
  std::vector<std::vector<int>> halves(const std::vector<int>& triangles) {
    const int a = farthest(triangles, distances(triangles.front()));
    const auto from_a = distances(a);
    const int b = farthest(triangles, from_a);
    const auto from_b = distances(b);
    const int first = part_[a], second = ++last_part_;
    for (const int t : triangles)
      if (from_b[t] < from_a[t]) part_[t] = second;
    shorten(triangles, first, second, a, b);
    return pieces(triangles);
  }

  /// Triangles go over to the other half while that makes the cut shorter.
  void shorten(const std::vector<int>& triangles, int first, int second, int a, int b) {
    constexpr int sweeps = 20;
    bool any = true;
    for (int i = 0; i < sweeps && any; ++i) {
      any = false;
      for (const int t : triangles) {
        const int other = part_[t] == first ? second : first;
        double own = 0, across = 0;
        for (const Neighbour& n : neighbours_[t]) {
          if (part_[n.triangle] == part_[t]) own += n.side;
          if (part_[n.triangle] == other) across += n.side;
        }
        if (t == a || t == b || !(own < across * (1 - 1e-9))) continue;
        part_[t] = other;
        any = true;
      }
    }
  }

  std::vector<std::vector<int>> pieces(const std::vector<int>& triangles) {
    std::vector<std::vector<int>> found;
    std::vector<char> seen(part_.size(), false);
    for (const int start : triangles) {
      if (seen[start]) continue;
      std::vector<int> piece{start};
      seen[start] = true;
      for (std::size_t i = 0; i < piece.size(); ++i)
        for (const Neighbour& n : neighbours_[piece[i]])
          if (!seen[n.triangle] && part_[n.triangle] == part_[start]) {
            seen[n.triangle] = true;
            piece.push_back(n.triangle);
          }
      found.push_back(std::move(piece));
    }
    for (const auto& piece : found) {
      ++last_part_;
      for (const int t : piece) part_[t] = last_part_;
    }
    return found;
  }

  std::vector<int> numbered() const {
    std::map<int, int> number;
    std::vector<int> out;
    for (const int p : part_)
      out.push_back(number.try_emplace(p, static_cast<int>(number.size())).first->second);
    return out;
  }

  const TriangleSurface& surface_;
  const std::vector<Vec3>& nodes_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<int> part_;
  int last_part_ = 0;
};

}  // namespace

std::vector<int> disc_parts(const TriangleSurface& surface, const std::vector<Vec3>& nodes,
                            const FitPart& fit) {
  return Cutter(surface, nodes).run(fit);
}

}  // namespace polyslip::mesh
