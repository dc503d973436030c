#include "mesh/size_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace polyslip::mesh {

using core::Vec3;

namespace {

/// dx/dt at t in 0 ... 1 of the quadratic segment through a (0), m (1/2), b (1).
Vec3 tangent(const Vec3& a, const Vec3& m, const Vec3& b, double t) {
  return (4 * t - 3) * a + (4 - 8 * t) * m + (4 * t - 1) * b;
}

/// The grading of one edge: element size h(s) = min(c_l, a0 + g s, a1 + g (L - s)), whose integral
/// of 1/h counts elements. Elements of lengths l, l p, l p^2 ... have g = ln p and a0 = l ln p /
/// (p - 1).
class Grading {
 public:
  Grading(double length, double from, double to, double size, double p) : length_(length) {
    growth_ = std::log(p);
    const double first = growth_ > 1e-9 ? growth_ / (p - 1) : 1;
    a0_ = from < size ? from * first : size;
    a1_ = to < size ? to * first : size;
    if (growth_ <= 1e-9) {
      growth_ = 0;
      size = a0_ = a1_ = std::min(a0_, a1_);
    }
    size_ = size;
    if (growth_ > 0) {
      rise_ = (size - a0_) / growth_;
      fall_ = length - (size - a1_) / growth_;
      if (rise_ > fall_) {
        rise_ = std::clamp((a1_ - a0_ + growth_ * length) / (2 * growth_), 0.0, length);
        fall_ = rise_;
      }
    } else {
      rise_ = 0;
      fall_ = length;
    }
    rise_count_ = count_on_ramp(a0_, rise_);
    flat_count_ = (fall_ - rise_) / size_;
    fall_count_ = count_on_ramp(a1_, length - fall_);
  }

  double count() const { return rise_count_ + flat_count_ + fall_count_; }

  /// Where `count` elements from the start end.
  double at(double count) const {
    if (count < rise_count_) return on_ramp(a0_, count);
    if (count < rise_count_ + flat_count_) return rise_ + (count - rise_count_) * size_;
    return length_ - on_ramp(a1_, this->count() - count);
  }

 private:
  double count_on_ramp(double start, double s) const {
    return growth_ > 0 ? std::log1p(growth_ * s / start) / growth_ : s / start;
  }
  double on_ramp(double start, double count) const {
    return growth_ > 0 ? start * std::expm1(growth_ * count) / growth_ : start * count;
  }

  double length_, size_ = 0, growth_ = 0, a0_ = 0, a1_ = 0, rise_ = 0, fall_ = 0;
  double rise_count_ = 0, flat_count_ = 0, fall_count_ = 0;
};

/// Whether adjacent elements differ by no more than p, but for the rounding of s.
bool progresses(const std::vector<double>& s, double p) {
  const double rounding = 1e-14 * s.back();
  for (std::size_t i = 2; i < s.size(); ++i) {
    const double a = s[i - 1] - s[i - 2], b = s[i] - s[i - 1];
    if (std::max(a, b) > p * std::min(a, b) * (1 + 1e-9) + p * rounding) return false;
  }
  return true;
}

}  // namespace

CurvedEdge::CurvedEdge(const EdgeShape& shape, const Vec3& scale)
    : shape_(&shape), scale_(scale), ends_{0} {
  for (int i = 0; 2 * i + 2 < static_cast<int>(shape.points.size()); ++i)
    ends_.push_back(ends_.back() + partial_length(i, 1));
}

// Three-point Gauss quadrature of |dx/dt| on eight intervals.
double CurvedEdge::partial_length(int segment, double t) const {
  const Vec3 a = shape_->points[2 * segment].cwiseProduct(scale_);
  const Vec3 m = shape_->points[2 * segment + 1].cwiseProduct(scale_);
  const Vec3 b = shape_->points[2 * segment + 2].cwiseProduct(scale_);
  constexpr int intervals = 8;
  const double half = t / (2 * intervals), offset = half * std::sqrt(0.6);
  double sum = 0;
  for (int i = 0; i < intervals; ++i) {
    const double middle = (2 * i + 1) * half;
    sum += 5 * tangent(a, m, b, middle - offset).norm() + 8 * tangent(a, m, b, middle).norm() +
           5 * tangent(a, m, b, middle + offset).norm();
  }
  return sum * half / 9;
}

Vec3 CurvedEdge::at(double s) const {
  if (s <= 0) return shape_->points.front();
  if (s >= length()) return shape_->points.back();
  const int segment =
      static_cast<int>(std::upper_bound(ends_.begin(), ends_.end(), s) - ends_.begin()) - 1;
  const double wanted = s - ends_[segment], whole = ends_[segment + 1] - ends_[segment];
  double low = 0, high = 1, t = wanted / whole;
  const auto& x = shape_->points;
  const Vec3 &a = x[2 * segment], &m = x[2 * segment + 1], &b = x[2 * segment + 2];
  for (int i = 0; i < 60; ++i) {
    const double error = partial_length(segment, t) - wanted;
    if (std::abs(error) <= 1e-14 * whole) break;
    (error > 0 ? high : low) = t;
    const double speed = tangent(a, m, b, t).cwiseProduct(scale_).norm();
    const double newton = t - error / speed;
    t = newton > low && newton < high ? newton : (low + high) / 2;
  }
  return (1 - t) * (1 - 2 * t) * a + 4 * t * (1 - t) * m + t * (2 * t - 1) * b;
}

ElementSizes element_sizes(const Topology& topology, const MeshingOptions& options) {
  const auto grains = static_cast<std::size_t>(topology.cell_count());
  constexpr double none = std::numeric_limits<double>::infinity();
  ElementSizes sizes{std::vector<double>(grains, options.element_size),
                     std::vector<double>(topology.faces.size(), none),
                     std::vector<double>(topology.edges.size(), none)};
  if (options.outer_element_size)
    for (const auto& face : topology.faces)
      if (face.domain_face >= 0) sizes.grains[face.cells[0]] = *options.outer_element_size;
  if (!options.grain_element_sizes.empty()) {
    if (options.grain_element_sizes.size() != grains)
      throw core::InputError(
          fmt::format("[mesh] grain_element_sizes: {} numbers for {} grains; give one a grain",
                      options.grain_element_sizes.size(), grains));
    sizes.grains = options.grain_element_sizes;
  }
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    for (const int c : topology.faces[f].cells)
      if (c >= 0) sizes.faces[f] = std::min(sizes.faces[f], sizes.grains[c]);
    for (const int e : topology.faces[f].edges)
      sizes.edges[e] = std::min(sizes.edges[e], sizes.faces[f]);
  }
  return sizes;
}

std::vector<double> vertex_sizes(const Topology& topology, const std::vector<double>& edge_lengths,
                                 const std::vector<double>& edge_sizes, double progression_factor) {
  std::vector<double> sizes(topology.vertex_count, std::numeric_limits<double>::infinity());
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    for (int v : topology.edges[e].vertices)
      sizes[v] = std::min({sizes[v], edge_sizes[e], progression_factor * edge_lengths[e]});
  return sizes;
}

// The count of elements is the one whose lengths are nearest to those asked for, in the ratio, then
// one more if the progression factor needs it: with n >= N elements each spans N/n <= 1 of the
// count N of the grading, whose size h changes by no more than p^(N/n) from one to the next as |h'|
// <= ln p; so the second try always does.
std::vector<double> edge_nodes(double length, double from, double to, double element_size,
                               double progression_factor, int least_count) {
  const Grading grading(length, from, to, element_size, progression_factor);
  const double count = grading.count();
  if (!(length > 0 && from > 0 && to > 0 && count < 1e8))
    throw core::RecoverableError(fmt::format(
        "1D meshing: edge of length {} with sizes {} and {}, c_l = {}, p_l = {}: {} elements",
        length, from, to, element_size, progression_factor, count));
  int n = std::max(1, static_cast<int>(count));
  if (count * count > static_cast<double>(n) * (n + 1)) ++n;
  for (n = std::max(n, least_count); n < count + 2 + least_count; ++n) {
    std::vector<double> s(n + 1, 0.0);
    for (int i = 1; i < n; ++i) s[i] = grading.at(count * i / n);
    s[n] = length;
    if (progresses(s, progression_factor)) return s;
  }
  throw core::InternalError(
      fmt::format("1D meshing: p_l = {} does not hold on an edge of length {} with sizes {} and {}",
                  progression_factor, length, from, to));
}

double largest_progression(const std::vector<double>& arcs) {
  double worst = 1;
  for (std::size_t i = 2; i < arcs.size(); ++i) {
    const double a = arcs[i - 1] - arcs[i - 2], b = arcs[i] - arcs[i - 1];
    if (!(a > 0 && b > 0)) return std::numeric_limits<double>::infinity();
    worst = std::max({worst, a / b, b / a});
  }
  return worst;
}

namespace {

/// The two parts of an edge, divided at `arc`, graded from size s there; empty if that takes many
/// more elements.
std::vector<double> graded_in_two(double length, double arc, double s, const EdgeGrading& g,
                                  std::size_t most) {
  auto nodes = edge_nodes(arc, g.from, s, g.element_size, g.progression_factor);
  const auto right = edge_nodes(length - arc, s, g.to, g.element_size, g.progression_factor);
  if (nodes.size() + right.size() > most) return {};
  for (std::size_t i = 1; i + 1 < right.size(); ++i) nodes.push_back(arc + right[i]);
  nodes.push_back(length);
  return nodes;
}

}  // namespace

std::vector<double> with_node_at(const std::vector<double>& arcs, double arc,
                                 const EdgeGrading& grading) {
  constexpr double near = 0.35;  // share of the element
  constexpr double finer = 0.7;
  constexpr int gradings = 5, mixtures = 8;
  const double p = grading.progression_factor;
  const auto fits = [p](const std::vector<double>& s) {
    return !s.empty() && largest_progression(s) <= p * (1 + 1e-9);
  };
  const auto above = std::upper_bound(arcs.begin(), arcs.end(), arc);
  if (above == arcs.begin() || above == arcs.end()) return arcs;
  auto nearer = static_cast<std::size_t>(above - arcs.begin());
  const double share = (arc - arcs[nearer - 1]) / (arcs[nearer] - arcs[nearer - 1]);
  if (share < 0.5) --nearer;
  auto moved = arcs;
  if (nearer > 0 && nearer + 1 < arcs.size()) moved[nearer] = arc;
  const bool can_move = moved != arcs;
  if (can_move && std::min(share, 1 - share) < near && fits(moved)) return moved;
  auto wanted = arcs;
  wanted.insert(wanted.begin() + (above - arcs.begin()), arc);
  if (fits(wanted)) return wanted;
  if (can_move && fits(moved)) return moved;
  double s = std::min({grading.element_size, arc, arcs.back() - arc});
  for (int i = 0; i < gradings; ++i, s *= finer) {
    auto nodes = graded_in_two(arcs.back(), arc, s, grading, 2 * arcs.size() + 4);
    if (fits(nodes)) return nodes;
  }
  const auto graded = edge_nodes(arcs.back(), grading.from, grading.to, grading.element_size, p,
                                 static_cast<int>(arcs.size()));
  for (int i = 1; i < mixtures && graded.size() == wanted.size(); ++i) {
    auto mixed = graded;
    const double part = static_cast<double>(i) / mixtures;
    for (std::size_t k = 1; k + 1 < mixed.size(); ++k)
      mixed[k] = part * graded[k] + (1 - part) * wanted[k];
    if (fits(mixed)) return mixed;
  }
  return graded;
}

}  // namespace polyslip::mesh
