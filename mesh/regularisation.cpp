// Regularisation of a Voronoi tessellation: short edges are deleted, from the shortest to the
// longest, in several loops (section 2.1.2 of Quey, Dawson, Barbe 2011).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "core/error.hpp"
#include "mesh/cell_complex.hpp"
#include "mesh/complex_shape.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

enum class Outcome { deleted, flatness, fold, topology, polyline, domain };

class Regulariser {
 public:
  Regulariser(Tessellation& tessellation, const RegularisationOptions& options)
      : tess_(tessellation),
        complex_(tessellation),
        options_(options),
        max_length_(options.max_edge_length),
        max_fault_(chord_of_degrees(options.max_flatness_fault)),
        search_fault_(chord_of_degrees(options.position_search * options.max_flatness_fault)),
        polyline_length_(options.polyline_share * options.max_edge_length),
        corner_cosine_(std::cos(options.min_corner_angle * std::numbers::pi / 180)) {}

  RegularisationReport run() {
    report_.edges_before = complex_.edge_count();
    report_.short_before = count_short();
    delete_short_edges();
    if (report_.deleted > 0 && options_.flattening_sweeps > 0) {
      for (int i = 0; i < options_.flattening_sweeps; ++i) flatten();
      delete_short_edges();
    }
    report_.short_after = count_short();
    for (int f = 0; f < complex_.face_count(); ++f)
      if (complex_.face(f).alive)
        report_.max_flatness_fault =
            std::max(report_.max_flatness_fault, degrees_of_chord(complex_.face(f).fault));
    complex_.store(tess_);
    return report_;
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
      const auto points = complex_.loop_points(f);
      for (std::size_t i = 0; i < 3; ++i) {
        if (vertices[i] == a || vertices[i] == b) continue;
        const Vec3 p = points[(i + 1) % 3] - points[i], q = points[(i + 2) % 3] - points[i];
        if (p.dot(q) > corner_cosine_ * p.norm() * q.norm()) return true;
      }
    }
    return false;
  }

  // Whether the edge is to be deleted, in loops that may leave polylines or not.
  bool is_wanted(int edge) const {
    if (!complex_.edge(edge).alive) return false;
    if (!polylines_) return is_short(edge);
    return complex_.length(edge) < polyline_length_ ||
           (max_length_ > 0 && faces_sharp_corner(edge));
  }

  int count_short() const {
    int n = 0;
    for (int e = 0; e < complex_.edge_count(); ++e) n += is_short(e);
    return n;
  }

  void delete_short_edges() {
    int before;
    do {
      before = report_.deleted;
      loops_until_nothing_changes(false);
      loops_until_nothing_changes(true);
    } while (report_.deleted != before);
  }

  void loops_until_nothing_changes(bool polylines) {
    polylines_ = polylines;
    for (int before = -1; before != report_.deleted;) {
      before = report_.deleted;
      ++report_.loops;
      const auto refused = loop();
      if (!polylines_) report_.refused = refused;
    }
  }

  // Each short edge once, in the order of lengths; edges of a new vertex again, since they moved.
  RegularisationReport::Refused loop() {
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    const auto push = [&](int edge) {
      if (is_wanted(edge)) queue.push({complex_.length(edge), edge});
    };
    for (int e = 0; e < complex_.edge_count(); ++e) push(e);
    RegularisationReport::Refused refused;
    while (!queue.empty()) {
      const auto [length, edge] = queue.top();
      queue.pop();
      if (!complex_.edge(edge).alive || complex_.length(edge) != length) continue;
      int vertex = -1;
      switch (try_edge(edge, vertex)) {
        case Outcome::deleted:
          for (const int e : complex_.vertex(vertex).edges) push(e);
          break;
        case Outcome::flatness:
          ++refused.flatness;
          break;
        case Outcome::fold:
          ++refused.fold;
          break;
        case Outcome::topology:
          ++refused.topology;
          break;
        case Outcome::polyline:
          ++refused.polyline;
          break;
        case Outcome::domain:
          ++refused.domain;
          break;
      }
    }
    return refused;
  }

  Outcome try_edge(int edge, int& vertex) {
    // Without any distortion only edges among triangles could be deleted: none is.
    if (max_fault_ == 0) return Outcome::flatness;
    using Obstacle = CellComplex::Obstacle;
    const Obstacle obstacle = complex_.obstacle(edge);
    if (obstacle == Obstacle::domain) return Outcome::domain;
    if (obstacle == Obstacle::topology) return Outcome::topology;
    const auto start = complex_.mark();
    const Trial single = collapse(edge);
    vertex = single.vertex;
    const Outcome outcome = judge(single, start);
    if (outcome == Outcome::deleted) {
      complex_.commit();
      ++report_.deleted;
      return outcome;
    }
    if (const int second = best_second_edge(vertex, start); second >= 0) {
      vertex = collapse(second).vertex;
      complex_.commit();
      report_.deleted += 2;
      return Outcome::deleted;
    }
    complex_.roll_back(start);
    return outcome;
  }

  Outcome judge(const Trial& trial, std::size_t start) const {
    if (trial.fault == infinity) return Outcome::fold;
    if (trial.fault > max_fault_) return Outcome::flatness;
    if (!polylines_ && complex_.polyline_since(start)) return Outcome::polyline;
    return cells_sound(complex_, trial.vertex) ? Outcome::deleted : Outcome::fold;
  }

  // The short edge of a new vertex whose deletion distorts least, within f_max; -1 if none does.
  int best_second_edge(int vertex, std::size_t start) {
    int best = -1;
    double best_fault = infinity;
    const auto edges = complex_.vertex(vertex).edges;
    for (const int e : edges) {
      if (!(is_short(e) || is_wanted(e)) || !complex_.can_collapse(e)) continue;
      const auto here = complex_.mark();
      const Trial trial = collapse(e);
      if (trial.fault < best_fault && judge(trial, start) == Outcome::deleted) {
        best = e;
        best_fault = trial.fault;
      }
      complex_.roll_back(here);
    }
    return best;
  }

  Trial collapse(int edge) {
    const double length = complex_.length(edge);
    const int vertex = complex_.collapse(edge);
    const auto faces = complex_.faces_at(vertex);
    complex_.move(vertex, least_squares_position(complex_, vertex, faces));
    const double fault = fit_faces(complex_, faces);
    if (fault > max_fault_ && options_.position_search > 1)
      return {vertex, search_position(vertex, faces, length)};
    return {vertex, fault};
  }

  // Compass search for a position within f_max, from the one of eq. (2), in steps from a quarter of
  // the deleted edge's length down to a 32nd.
  double search_position(int vertex, const std::vector<int>& faces, double length) {
    double fault = largest_fault(vertex, complex_.vertex(vertex).position, faces, infinity);
    if (!(fault <= search_fault_)) return fit_faces(complex_, faces);
    Vec3 best = complex_.vertex(vertex).position;
    const auto planes = complex_.planes_at(vertex);
    const Directions free = free_directions(planes);
    for (double step = length / 4; step > length / 50 && fault > max_fault_;) {
      bool better = false;
      for (int i = 0; i < 2 * free.count && fault > max_fault_; ++i) {
        Vec3 x = best + (i % 2 ? step : -step) * free[i / 2];
        put_on_planes(planes, x);
        const double there = largest_fault(vertex, x, faces, fault);
        if (there < fault) {
          fault = there;
          best = x;
          better = true;
        }
      }
      if (!better) step /= 2;
    }
    complex_.move(vertex, best);
    return fit_faces(complex_, faces);
  }

  // Moves the vertex. The largest flatness fault of its faces, or `enough` or more.
  double largest_fault(int vertex, const Vec3& x, const std::vector<int>& faces, double enough) {
    complex_.move(vertex, x);
    double fault = 0;
    for (const int f : faces) {
      fault = std::max(fault, best_fan(complex_.loop_points(f)).fault);
      if (fault >= enough) break;
    }
    return fault;
  }

  // Each vertex of distorted faces moves towards where these are flattest, the whole, a half or a
  // quarter of the way, if that lowers the sum of their squared faults.
  void flatten() {
    for (int v = 0; v < complex_.vertex_count(); ++v) {
      if (!complex_.vertex(v).alive) continue;
      const auto faces = complex_.faces_at(v);
      double worst = max_fault_;
      const double sum = sum_of_faults(faces, worst);
      if (!(sum > negligible_fault)) continue;
      const Vec3 from = complex_.vertex(v).position;
      const Vec3 way = flattest_position(complex_, v, faces) - from;
      for (const double part : {1.0, 0.5, 0.25}) {
        const auto start = complex_.mark();
        complex_.move(v, from + part * way);
        double ignored = 0;
        if (fit_faces(complex_, faces) <= worst && sum_of_faults(faces, ignored) < sum &&
            cells_sound(complex_, v)) {
          complex_.commit();
          break;
        }
        complex_.roll_back(start);
      }
    }
  }

  double sum_of_faults(const std::vector<int>& faces, double& worst) const {
    double sum = 0;
    for (const int f : faces) {
      sum += complex_.face(f).fault;
      worst = std::max(worst, complex_.face(f).fault);
    }
    return sum;
  }

  /// Squared chord of a hundredth of a degree or so: faces are flat.
  static constexpr double negligible_fault = 3e-8;

  Tessellation& tess_;
  CellComplex complex_;
  RegularisationOptions options_;
  double max_length_, max_fault_, search_fault_;
  double polyline_length_, corner_cosine_;
  bool polylines_ = false;  ///< whether deletions may leave polylines
  RegularisationReport report_;
};

void check_options(const RegularisationOptions& options) {
  if (!(options.max_edge_length >= 0) || !std::isfinite(options.max_edge_length))
    throw core::InputError(
        fmt::format("max_edge_length = {}: must be a length, 0 for none", options.max_edge_length));
  if (!(options.max_flatness_fault >= 0 && options.max_flatness_fault < 90))
    throw core::InputError(fmt::format("max_flatness_fault = {}: must be 0 to below 90 degrees",
                                       options.max_flatness_fault));
  if (!(options.polyline_share >= 0 && options.polyline_share <= 1))
    throw core::InputError(
        fmt::format("polyline_share = {}: must be 0 to 1", options.polyline_share));
  if (!(options.min_corner_angle >= 0 && options.min_corner_angle < 90))
    throw core::InputError(fmt::format("min_corner_angle = {}: must be 0 to below 90 degrees",
                                       options.min_corner_angle));
  if (!(options.position_search >= 1 && options.position_search <= 4))
    throw core::InputError(
        fmt::format("position_search = {}: must be 1 to 4", options.position_search));
  if (options.flattening_sweeps < 0)
    throw core::InputError(
        fmt::format("flattening_sweeps = {}: must be 0 or more", options.flattening_sweeps));
}

}  // namespace

RegularisationReport regularise(Tessellation& tessellation, const RegularisationOptions& options) {
  check_options(options);
  return Regulariser(tessellation, options).run();
}

}  // namespace polyslip::mesh
