#include "mesh/planar_triangulation.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace polyslip::mesh {

namespace {

__extension__ using Int128 = __int128;

/// Whether c, on the line through a and b, lies between them or on one of them.
bool within(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return std::min(a.x, b.x) <= c.x && c.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= c.y &&
         c.y <= std::max(a.y, b.y);
}

/// Whether the closed segments ab and cd have a point in common.
bool segments_meet(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
    return false;
  const auto sign = [](std::int64_t v) { return (v > 0) - (v < 0); };
  const int abc = sign(orientation(a, b, c)), abd = sign(orientation(a, b, d));
  const int cda = sign(orientation(c, d, a)), cdb = sign(orientation(c, d, b));
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && within(a, b, c)) || (abd == 0 && within(a, b, d)) ||
         (cda == 0 && within(c, d, a)) || (cdb == 0 && within(c, d, b));
}

}  // namespace

bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const std::int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y;
  const std::int64_t cx = c.x - d.x, cy = c.y - d.y;
  const Int128 bc = Int128(bx) * cy - Int128(by) * cx;
  const Int128 ca = Int128(cx) * ay - Int128(cy) * ax;
  const Int128 ab = Int128(ax) * by - Int128(ay) * bx;
  const Int128 det = (Int128(ax) * ax + Int128(ay) * ay) * bc +
                     (Int128(bx) * bx + Int128(by) * by) * ca +
                     (Int128(cx) * cx + Int128(cy) * cy) * ab;
  return det > 0;
}

bool is_simple(const std::vector<GridPoint>& p) {
  const int n = static_cast<int>(p.size());
  if (n < 3) return false;
  Int128 area = 0;
  for (int i = 0; i < n; ++i) {
    const auto &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
    area += Int128(a.x) * b.y - Int128(a.y) * b.x;
    if (a == b) return false;
    const std::int64_t dot = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y);
    if (orientation(a, b, c) == 0 && dot <= 0) return false;
  }
  if (area <= 0) return false;
  for (int i = 0; i < n; ++i)
    for (int j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (segments_meet(p[i], p[i + 1], p[j], p[(j + 1) % n])) return false;
    }
  return true;
}

PlanarTriangulation::PlanarTriangulation(const std::vector<GridPoint>& polygon)
    : points_(polygon), boundary_count_(static_cast<int>(polygon.size())) {
  cut_ears(polygon);
  link();
  make_delaunay();
}

// Of the corners that are ears the one with the largest least height is cut, so that flat triangles
// along straight rows of points are the last choice.
void PlanarTriangulation::cut_ears(const std::vector<GridPoint>& p) {
  std::vector<int> loop(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) loop[i] = static_cast<int>(i);
  while (loop.size() > 3) {
    const int n = static_cast<int>(loop.size());
    int best = -1;
    double best_height = 0;
    for (int i = 0; i < n; ++i) {
      const int ia = loop[(i + n - 1) % n], ib = loop[i], ic = loop[(i + 1) % n];
      const auto &a = p[ia], &b = p[ib], &c = p[ic];
      const std::int64_t area = orientation(a, b, c);
      if (area <= 0) continue;
      const double length =
          std::max({std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y),
                    std::hypot(a.x - c.x, a.y - c.y)});
      if (static_cast<double>(area) / length <= best_height) continue;
      const bool empty = std::none_of(loop.begin(), loop.end(), [&](int k) {
        return k != ia && k != ib && k != ic && orientation(a, b, p[k]) >= 0 &&
               orientation(b, c, p[k]) >= 0 && orientation(c, a, p[k]) >= 0;
      });
      if (!empty) continue;
      best = i;
      best_height = static_cast<double>(area) / length;
    }
    if (best < 0) throw core::InternalError("planar mesher: a simple polygon has no ear");
    triangles_.push_back(
        {{loop[(best + n - 1) % n], loop[best], loop[(best + 1) % n]}, {-1, -1, -1}});
    loop.erase(loop.begin() + best);
  }
  triangles_.push_back({{loop[0], loop[1], loop[2]}, {-1, -1, -1}});
}

void PlanarTriangulation::link() {
  struct Side {
    int a, b, triangle, corner;
  };
  std::vector<Side> sides;
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    for (int i = 0; i < 3; ++i) {
      const int a = triangles_[t].v[(i + 1) % 3], b = triangles_[t].v[(i + 2) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, i});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& s, const Side& r) { return s.a != r.a ? s.a < r.a : s.b < r.b; });
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &s = sides[i], &r = sides[i + 1];
    if (s.a != r.a || s.b != r.b) continue;
    triangles_[s.triangle].n[s.corner] = r.triangle;
    triangles_[r.triangle].n[r.corner] = s.triangle;
  }
}

void PlanarTriangulation::replace_neighbour(int triangle, int old_neighbour, int new_neighbour) {
  if (triangle < 0) return;
  for (int& n : triangles_[triangle].n)
    if (n == old_neighbour) {
      n = new_neighbour;
      return;
    }
}

/// Flips the edge opposite to `corner` if the neighbour's corner lies inside the circle and both
/// new triangles are positive. Afterwards the two triangles are `triangle` and `other`.
bool PlanarTriangulation::flip_if_needed(int triangle, int corner, int& other) {
  Triangle& t = triangles_[triangle];
  other = t.n[corner];
  if (other < 0) return false;
  Triangle& o = triangles_[other];
  const int a = t.v[corner], b = t.v[(corner + 1) % 3], c = t.v[(corner + 2) % 3];
  int k = 0;
  while (o.v[k] == b || o.v[k] == c) ++k;
  const int d = o.v[k];
  const auto& p = points_;
  // With a flat triangle (a on bc) the circle is that of the other one.
  const bool inside = orientation(p[a], p[b], p[c]) > 0 ? in_circle(p[a], p[b], p[c], p[d])
                                                        : in_circle(p[d], p[c], p[b], p[a]);
  if (!inside || orientation(p[a], p[b], p[d]) <= 0 || orientation(p[a], p[d], p[c]) <= 0)
    return false;
  const int t_ab = t.n[(corner + 2) % 3], t_ca = t.n[(corner + 1) % 3];
  const int o_dc = o.n[(std::find(o.v.begin(), o.v.end(), b) - o.v.begin())];
  const int o_bd = o.n[(std::find(o.v.begin(), o.v.end(), c) - o.v.begin())];
  t = {{a, b, d}, {o_bd, other, t_ab}};
  o = {{a, d, c}, {o_dc, t_ca, triangle}};
  replace_neighbour(o_bd, other, triangle);
  replace_neighbour(t_ca, triangle, other);
  return true;
}

void PlanarTriangulation::legalise(std::vector<std::array<int, 2>>& stack,
                                   std::vector<int>* changed) {
  while (!stack.empty()) {
    const auto [triangle, point] = stack.back();
    stack.pop_back();
    const auto& v = triangles_[triangle].v;
    const auto at = std::find(v.begin(), v.end(), point);
    if (at == v.end()) continue;
    int other = -1;
    if (!flip_if_needed(triangle, static_cast<int>(at - v.begin()), other)) continue;
    if (changed) changed->push_back(other);
    stack.push_back({triangle, point});
    stack.push_back({other, point});
  }
}

bool PlanarTriangulation::make_delaunay() {
  bool any = false, flipped = true;
  while (flipped) {
    flipped = false;
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
      for (int i = 0; i < 3; ++i) {
        int other = -1;
        if (flip_if_needed(t, i, other)) flipped = any = true;
      }
  }
  return any;
}

int PlanarTriangulation::locate(const GridPoint& p, int start) const {
  int t = start;
  for (std::size_t step = 0; step <= triangles_.size(); ++step) {
    const auto& triangle = triangles_[t];
    int next = -2, zeros = 0, zero_side = -1;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t side =
          orientation(points_[triangle.v[(i + 1) % 3]], points_[triangle.v[(i + 2) % 3]], p);
      if (side < 0) {
        next = triangle.n[i];
        break;
      }
      if (side == 0) ++zeros, zero_side = i;
    }
    if (next == -2) {
      const bool usable = zeros == 0 || (zeros == 1 && triangle.n[zero_side] >= 0);
      return usable ? t : -1;
    }
    if (next == -1) return -1;
    t = next;
  }
  return -1;
}

void PlanarTriangulation::insert(const GridPoint& p, int triangle, std::vector<int>& changed) {
  const int point = static_cast<int>(points_.size());
  points_.push_back(p);
  const Triangle t = triangles_[triangle];
  const int t1 = static_cast<int>(triangles_.size()), t2 = t1 + 1;
  triangles_[triangle] = {{point, t.v[1], t.v[2]}, {t.n[0], t1, t2}};
  triangles_.push_back({{point, t.v[2], t.v[0]}, {t.n[1], t2, triangle}});
  triangles_.push_back({{point, t.v[0], t.v[1]}, {t.n[2], triangle, t1}});
  replace_neighbour(t.n[1], triangle, t1);
  replace_neighbour(t.n[2], triangle, t2);
  for (int k : {triangle, t1, t2}) changed.push_back(k);
  // A flat new triangle goes first: its edge must be flipped before any other.
  std::vector<std::array<int, 2>> stack{{triangle, point}, {t1, point}, {t2, point}};
  std::stable_sort(stack.begin(), stack.end(), [&](const auto& a, const auto& b) {
    const auto area = [&](int k) {
      const auto& v = triangles_[k].v;
      return orientation(points_[v[0]], points_[v[1]], points_[v[2]]);
    };
    return (area(a[0]) != 0) > (area(b[0]) != 0);
  });
  legalise(stack, &changed);
}

bool PlanarTriangulation::split_edge(int a, int b) {
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    for (int i = 0; i < 3; ++i) {
      const Triangle tri = triangles_[t];
      if (tri.v[(i + 1) % 3] != a || tri.v[(i + 2) % 3] != b || tri.n[i] < 0) continue;
      const int o = tri.n[i];
      const Triangle other = triangles_[o];
      const int c = tri.v[i];
      int k = 0;
      while (other.v[k] == a || other.v[k] == b) ++k;
      const int d = other.v[k];
      const auto& p = points_;
      const GridPoint m{(p[a].x + p[b].x) / 2, (p[a].y + p[b].y) / 2};
      if (orientation(p[c], p[a], m) <= 0 || orientation(p[c], m, p[b]) <= 0 ||
          orientation(p[d], p[b], m) <= 0 || orientation(p[d], m, p[a]) <= 0)
        return false;
      const int point = static_cast<int>(points_.size());
      points_.push_back(m);
      const int n_ca = tri.n[(i + 2) % 3], n_bc = tri.n[(i + 1) % 3];
      const int n_db = other.n[std::find(other.v.begin(), other.v.end(), a) - other.v.begin()];
      const int n_ad = other.n[std::find(other.v.begin(), other.v.end(), b) - other.v.begin()];
      const int t1 = static_cast<int>(triangles_.size()), o1 = t1 + 1;
      triangles_[t] = {{c, a, point}, {o1, t1, n_ca}};
      triangles_.push_back({{c, point, b}, {o, n_bc, t}});
      triangles_[o] = {{d, b, point}, {t1, o1, n_db}};
      triangles_.push_back({{d, point, a}, {t, n_ad, o}});
      replace_neighbour(n_bc, t, t1);
      replace_neighbour(n_ad, o, o1);
      return true;
    }
  return false;
}

}  // namespace polyslip::mesh
