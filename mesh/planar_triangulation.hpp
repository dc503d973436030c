#pragma once
// Constrained Delaunay triangulation of a simple polygon on an integer grid, where the predicates
// are exact: coordinates of less than 2^28 in size need 117 bits in the in-circle determinant.

#include <array>
#include <cstdint>
#include <vector>

namespace polyslip::mesh {

/// A point of the grid; |x|, |y| < 2^28.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  bool operator==(const GridPoint&) const = default;
};

/// Twice the area of (a, b, c): positive if they turn left. Exact.
inline std::int64_t orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d lies strictly inside the circle through a, b, c, which turn left. Exact.
bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d);

/// Whether the closed polygon neither meets nor touches itself and turns left (positive area).
/// Flat corners are allowed, spikes and repeated points are not.
bool is_simple(const std::vector<GridPoint>& polygon);

class PlanarTriangulation {
 public:
  struct Triangle {
    std::array<int, 3> v{};  ///< corners, turning left
    std::array<int, 3> n{};  ///< neighbour opposite to corner i; -1 on the polygon
  };

  /// Of a simple polygon (is_simple). Ears are cut, then edges flipped.
  explicit PlanarTriangulation(const std::vector<GridPoint>& polygon);

  const std::vector<GridPoint>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  int boundary_count() const { return boundary_count_; }

  /// Triangle that holds p, by a walk from `start`; -1 if the walk leaves the polygon, or if p lies
  /// on it or on a corner.
  int locate(const GridPoint& p, int start) const;
  /// Adds a point inside `triangle` (from locate) and flips to Delaunay. Triangles that changed are
  /// appended to `changed`.
  void insert(const GridPoint& p, int triangle, std::vector<int>& changed);
  /// Moves an inner point, which must keep its triangles positive.
  void move(int point, const GridPoint& p) { points_[point] = p; }
  /// Flips every edge that is not Delaunay; whether any was.
  bool make_delaunay();
  /// Splits the inner edge (a, b) at its middle, without flips; false if there is no such inner
  /// edge or no grid point that keeps the four triangles positive.
  bool split_edge(int a, int b);

 private:
  void cut_ears(const std::vector<GridPoint>& polygon);
  void link();
  bool flip_if_needed(int triangle, int corner, int& other);
  void legalise(std::vector<std::array<int, 2>>& stack, std::vector<int>* changed);
  void replace_neighbour(int triangle, int old_neighbour, int new_neighbour);

  std::vector<GridPoint> points_;  ///< the polygon's, then inner ones
  std::vector<Triangle> triangles_;
  int boundary_count_ = 0;
};

}  // namespace polyslip::mesh
