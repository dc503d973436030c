// Regularisation of a Voronoi tessellation: short edges are deleted, from the shortest to the
// longest, in several loops (section 2.1.2 of Quey, Dawson, Barbe 2011).

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "core/error.hpp"
#include "mesh/cell_complex.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Mat3;
using core::Vec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

enum class Outcome { deleted, distorted, impossible };

class Regulariser {
 public:
  Regulariser(Tessellation& tessellation, const RegularisationOptions& options)
      : tess_(tessellation),
        complex_(tessellation),
        max_length_(options.max_edge_length),
        max_fault_(chord_of_degrees(options.max_flatness_fault)),
        polyline_length_(options.polyline_share * options.max_edge_length),
        polyline_cosine_(std::cos(options.polyline_angle * std::numbers::pi / 180)) {}

  RegularisationReport run() {
    RegularisationReport report;
    report.edges_before = complex_.edge_count();
    report.short_before = count_short();
    int before;
    do {
      before = report.deleted;
      loops_until_nothing_changes(false, report);
      loops_until_nothing_changes(true, report);
    } while (report.deleted != before);
    report.short_after = count_short();
    for (int f = 0; f < complex_.face_count(); ++f)
      if (complex_.face(f).alive)
        report.max_flatness_fault =
            std::max(report.max_flatness_fault, degrees_of_chord(complex_.face(f).fault));
    complex_.store(tess_);
    return report;
  }

 private:
  struct Candidate {
    double length;
    int edge;
    bool operator>(const Candidate& other) const {
      return length != other.length ? length > other.length : edge > other.edge;
    }
  };

  /// A state that was tried: the vertex at its centre and the largest fault of its faces (squared
  /// chord), infinite if something folds.
  struct Trial {
    int vertex = -1;
    double fault = infinity;
  };

  bool is_short(int edge) const {
    return complex_.edge(edge).alive && complex_.length(edge) < max_length_;
  }

  // Whether the edge is opposite to a sharp corner of a triangular face.
  bool faces_sharp_corner(int edge) const {
    const auto [a, b] = complex_.edge(edge).vertices;
    for (const int f : complex_.edge(edge).faces) {
      const auto vertices = complex_.loop_vertices(f);
      if (vertices.size() != 3) continue;
      for (const int v : vertices) {
        if (v == a || v == b) continue;
        const Vec3 p = complex_.vertex(a).position - complex_.vertex(v).position;
        const Vec3 q = complex_.vertex(b).position - complex_.vertex(v).position;
        if (p.dot(q) > polyline_cosine_ * p.norm() * q.norm()) return true;
      }
    }
    return false;
  }

  bool may_leave_polyline(int edge) const {
    return complex_.length(edge) < polyline_length_ || faces_sharp_corner(edge);
  }

  int count_short() const {
    int n = 0;
    for (int e = 0; e < complex_.edge_count(); ++e) n += is_short(e);
    return n;
  }

  void loops_until_nothing_changes(bool polylines, RegularisationReport& report) {
    polylines_ = polylines;
    for (int before = -1; before != report.deleted;) {
      before = report.deleted;
      ++report.loops;
      loop(report);
    }
  }

  // Each short edge once, in the order of lengths; edges of a new vertex again, since they moved.
  void loop(RegularisationReport& report) {
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    const auto push = [&](int edge) {
      if (is_short(edge) && (!polylines_ || may_leave_polyline(edge)))
        queue.push({complex_.length(edge), edge});
    };
    for (int e = 0; e < complex_.edge_count(); ++e) push(e);
    int distorted = 0, impossible = 0;
    while (!queue.empty()) {
      const auto [length, edge] = queue.top();
      queue.pop();
      if (!complex_.edge(edge).alive || complex_.length(edge) != length) continue;
      int vertex = -1;
      switch (try_edge(edge, vertex, report.deleted)) {
        case Outcome::deleted:
          for (const int e : complex_.vertex(vertex).edges) push(e);
          break;
        case Outcome::distorted:
          ++distorted;
          break;
        case Outcome::impossible:
          ++impossible;
          break;
      }
    }
    if (polylines_) return;
    report.refused_flatness = distorted;
    report.refused_topology = impossible;
  }

  Outcome try_edge(int edge, int& vertex, int& deleted) {
    if (!complex_.can_collapse(edge)) return Outcome::impossible;
    const auto start = complex_.mark();
    const Trial single = collapse(edge);
    vertex = single.vertex;
    if (single.fault <= max_fault_ && sound(vertex, start)) {
      complex_.commit();
      ++deleted;
      return Outcome::deleted;
    }
    if (const int second = best_second_edge(vertex, start); second >= 0) {
      vertex = collapse(second).vertex;
      complex_.commit();
      deleted += 2;
      return Outcome::deleted;
    }
    complex_.roll_back(start);
    const bool distorted = single.fault > max_fault_ && single.fault < infinity;
    return distorted ? Outcome::distorted : Outcome::impossible;
  }

  // The short edge of a new vertex whose deletion distorts least, within f_max; -1 if none does.
  int best_second_edge(int vertex, std::size_t start) {
    int best = -1;
    double best_fault = infinity;
    const auto edges = complex_.vertex(vertex).edges;
    for (const int e : edges) {
      if (!is_short(e) || !complex_.can_collapse(e)) continue;
      const auto here = complex_.mark();
      const Trial trial = collapse(e);
      if (trial.fault <= max_fault_ && trial.fault < best_fault && sound(trial.vertex, start)) {
        best = e;
        best_fault = trial.fault;
      }
      complex_.roll_back(here);
    }
    return best;
  }

  Trial collapse(int edge) {
    const int vertex = complex_.collapse(edge);
    const auto faces = complex_.faces_at(vertex);
    complex_.move(vertex, least_squares_position(vertex, faces));
    double worst = 0;
    for (const int f : faces) {
      const auto points = complex_.loop_points(f);
      const BestFan fan = best_fan(points);
      complex_.set_fan(f, fan.master, fan.fault);
      worst = std::max(worst, fan.fault);
      if (!sound_face(f, points, fan.master)) return {vertex, infinity};
    }
    return {vertex, worst};
  }

  bool sound_face(int f, const std::vector<Vec3>& points, int master) const {
    return vector_area(points).dot(tess_.face_planes[f].normal) > 0 &&
           unfolded_in_projection(points, master);
  }

  // Eq. (2): least squares of the distances to the faces' planes in the Voronoi tessellation. The
  // vertex stays on its domain faces. Where the planes leave its position open it stays near the
  // mid point of the edge, from which it comes.
  Vec3 least_squares_position(int vertex, const std::vector<int>& faces) const {
    const auto& v = complex_.vertex(vertex);
    Mat3 normal_matrix = Mat3::Zero();
    Vec3 residual = Vec3::Zero();
    for (const int f : faces) {
      if (complex_.face(f).domain_face >= 0) continue;
      const Plane& plane = tess_.face_planes[f];
      normal_matrix += plane.normal * plane.normal.transpose();
      residual += plane.normal * (plane.offset - plane.normal.dot(v.position));
    }
    normal_matrix += towards_mid_point * Mat3::Identity();
    for (int w = 0; w < 6; ++w) {
      if (!(v.walls >> w & 1)) continue;
      const int axis = w / 2;
      normal_matrix.row(axis).setZero();
      normal_matrix.col(axis).setZero();
      normal_matrix(axis, axis) = 1;
      residual[axis] = 0;
    }
    Vec3 position = v.position + normal_matrix.ldlt().solve(residual);
    for (int w = 0; w < 6; ++w)
      if (v.walls >> w & 1) position[w / 2] = v.position[w / 2];
    return position;
  }

  bool sound(int vertex, std::size_t start) const {
    return (polylines_ || !complex_.polyline_since(start)) && cells_sound(vertex);
  }

  // Each cell at the vertex is seen as a whole, and right side out, from its centroid: then its
  // faces cannot cross one another.
  bool cells_sound(int vertex) const {
    for (const int c : complex_.cells_at(vertex))
      if (c >= 0 && !seen_from_centroid(c)) return false;
    return true;
  }

  template <class Visit>
  void for_each_triangle(int cell, Visit&& visit) const {
    for (const int f : complex_.cell(cell).faces) {
      const auto& face = complex_.face(f);
      const bool outwards = face.cells[0] == cell;
      for_each_fan_triangle(complex_.loop_points(f), face.master,
                            [&](const Vec3& a, const Vec3& b, const Vec3& m) {
                              outwards ? visit(a, b, m) : visit(b, a, m);
                            });
    }
  }

  bool seen_from_centroid(int cell) const {
    const Vec3 origin = tess_.seeds[cell];
    double volume = 0;
    Vec3 moment = Vec3::Zero();
    for_each_triangle(cell, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
      const Vec3 p = a - origin, q = b - origin, r = m - origin;
      const double part = p.dot(q.cross(r));
      volume += part;
      moment += part * (p + q + r) / 4;
    });
    if (!(volume > 0)) return false;
    const Vec3 centroid = origin + moment / volume;
    bool seen = true;
    for_each_triangle(cell, [&](const Vec3& a, const Vec3& b, const Vec3& m) {
      if (!((a - centroid).dot((b - centroid).cross(m - centroid)) > 0)) seen = false;
    });
    return seen;
  }

  /// Weight of the distance to the mid point against that to one plane, squared.
  static constexpr double towards_mid_point = 1e-4;

  Tessellation& tess_;
  CellComplex complex_;
  double max_length_, max_fault_;
  double polyline_length_, polyline_cosine_;
  bool polylines_ = false;  ///< whether deletions may leave polylines
};

}  // namespace

RegularisationReport regularise(Tessellation& tessellation, const RegularisationOptions& options) {
  if (!(options.max_edge_length >= 0) || !std::isfinite(options.max_edge_length))
    throw core::InputError(
        fmt::format("max_edge_length = {}: must be a length, 0 for none", options.max_edge_length));
  if (!(options.max_flatness_fault >= 0 && options.max_flatness_fault < 90))
    throw core::InputError(fmt::format("max_flatness_fault = {}: must be 0 to below 90 degrees",
                                       options.max_flatness_fault));
  if (!(options.polyline_share >= 0 && options.polyline_share <= 1))
    throw core::InputError(
        fmt::format("polyline_share = {}: must be 0 to 1", options.polyline_share));
  if (!(options.polyline_angle >= 0 && options.polyline_angle < 90))
    throw core::InputError(
        fmt::format("polyline_angle = {}: must be 0 to below 90 degrees", options.polyline_angle));
  // Without any distortion nothing can be deleted, but for edges among triangles only: none.
  auto effective = options;
  if (options.max_flatness_fault == 0) effective.max_edge_length = 0;
  return Regulariser(tessellation, effective).run();
}

}  // namespace polyslip::mesh
