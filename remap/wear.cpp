#include "remap/wear.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/minimum.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::remap {
namespace {

using core::Mat3;
using core::Vec3;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int corners = 4, points = 4;

/// Gradients of the shape functions at the corners, then at the points of the four-point rule.
std::array<std::array<Vec3, 10>, corners + points> sample_gradients() {
  std::array<std::array<Vec3, 10>, corners + points> gradients;
  const auto rule = mesh::tet_quadrature_4();
  for (int i = 0; i < corners; ++i)
    gradients[i] = mesh::tet10_gradients(i == 0 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(i - 1)));
  for (int q = 0; q < points; ++q) gradients[corners + q] = mesh::tet10_gradients(rule[q].xi);
  return gradients;
}

struct ElementWear {
  double radius_ratio = 1, jacobian = 1, inversion_strain = infinity;
};

/// The smallest d in (0, horizon] at which det(j + d rate) vanishes; infinite if there is none. The
/// determinant is a cubic in d; the horizon is short, so that a few intervals part its roots.
double first_root(const Mat3& j, const Mat3& rate, double horizon) {
  const auto value = [&](double d) { return (j + d * rate).determinant(); };
  double low = 0;
  if (!(value(low) > 0)) return 0;
  constexpr int intervals = 8, bisections = 30;
  for (int i = 1; i <= intervals; ++i) {
    double high = horizon * i / intervals;
    if (value(high) > 0) {
      low = high;
      continue;
    }
    for (int k = 0; k < bisections; ++k) {
      const double middle = (low + high) / 2;
      (value(middle) > 0 ? low : high) = middle;
    }
    return high;
  }
  return infinity;
}

std::array<Vec3, 10> nodes_of(const std::array<int, 10>& element, std::span<const Vec3> values) {
  std::array<Vec3, 10> x;
  for (int i = 0; i < 10; ++i) x[i] = values[static_cast<std::size_t>(element[i])];
  return x;
}

class ElementGauge {
 public:
  ElementGauge(std::span<const Vec3> positions, std::span<const Vec3> rates, const Mat3& frame,
               double horizon)
      : positions_(positions),
        rates_(rates),
        frame_(frame),
        orientation_(frame.determinant() > 0 ? 1 : -1),
        horizon_(horizon) {}

  ElementWear operator()(const std::array<int, 10>& element) const {
    const auto x = nodes_of(element, positions_);
    ElementWear wear;
    wear.radius_ratio = orientation_ * mesh::radius_ratio(frame_ * x[0], frame_ * x[1],
                                                          frame_ * x[2], frame_ * x[3]);
    std::array<Mat3, corners + points> j;
    double least = infinity, mean = 0;
    for (std::size_t i = 0; i < j.size(); ++i) {
      j[i] = mesh::tet10_jacobian(x, gradients_[i]);
      const double det = j[i].determinant();
      least = mesh::min_or_nan(least, det);
      if (i >= corners) mean += det / points;
    }
    wear.jacobian = mean > 0 ? least / mean : 0;
    if (rates_.empty()) return wear;
    const auto v = nodes_of(element, rates_);
    for (std::size_t i = corners; i < j.size(); ++i)
      wear.inversion_strain =
          std::min(wear.inversion_strain,
                   first_root(j[i], mesh::tet10_jacobian(v, gradients_[i]), horizon_));
    return wear;
  }

 private:
  std::span<const Vec3> positions_, rates_;
  Mat3 frame_;
  double orientation_;
  double horizon_;
  std::array<std::array<Vec3, 10>, corners + points> gradients_ = sample_gradients();
};

}  // namespace

std::vector<Vec3> initial_positions(const mesh::Snapshot& snapshot) {
  std::vector<Vec3> initial = snapshot.mesh.nodes;
  const mesh::Field* u = snapshot.find("displacement", mesh::Location::node);
  if (!u) return initial;
  for (std::size_t n = 0; n < initial.size(); ++n)
    initial[n] -= Vec3(u->values[3 * n], u->values[3 * n + 1], u->values[3 * n + 2]);
  return initial;
}

PartWear measure_part(std::span<const std::array<int, 10>> tetrahedra,
                      std::span<const Vec3> positions, std::span<const Vec3> rates,
                      const Mat3& frame, const WearOptions& options, int threads) {
  const ElementGauge gauge(positions, rates, frame, options.inversion_strain);
  std::vector<ElementWear> elements(tetrahedra.size());
  constexpr std::size_t block = 1024;
  core::parallel_for(threads, (elements.size() + block - 1) / block, [&](std::size_t b) {
    const std::size_t end = std::min(elements.size(), (b + 1) * block);
    for (std::size_t e = b * block; e < end; ++e) elements[e] = gauge(tetrahedra[e]);
  });
  PartWear part;
  part.elements = static_cast<std::int64_t>(elements.size());
  for (const ElementWear& e : elements) {
    part.worst_radius_ratio = mesh::min_or_nan(part.worst_radius_ratio, e.radius_ratio);
    part.worst_jacobian = mesh::min_or_nan(part.worst_jacobian, e.jacobian);
    part.inversion_strain = mesh::min_or_nan(part.inversion_strain, e.inversion_strain);
    part.poor += !(e.radius_ratio >= options.poor_radius_ratio);
  }
  return part;
}

Wear whole_wear(std::span<const PartWear> parts) {
  Wear wear;
  wear.inversion_strain = infinity;
  std::int64_t elements = 0, poor = 0;
  for (const PartWear& part : parts) {
    wear.worst_radius_ratio = mesh::min_or_nan(wear.worst_radius_ratio, part.worst_radius_ratio);
    wear.worst_jacobian = mesh::min_or_nan(wear.worst_jacobian, part.worst_jacobian);
    wear.inversion_strain = mesh::min_or_nan(wear.inversion_strain, part.inversion_strain);
    elements += part.elements;
    poor += part.poor;
  }
  if (elements > 0) wear.poor_share = static_cast<double>(poor) / static_cast<double>(elements);
  return wear;
}

Wear measure_wear(std::span<const std::array<int, 10>> tetrahedra, std::span<const Vec3> positions,
                  std::span<const Vec3> rates, const Mat3& frame, const WearOptions& options,
                  int threads) {
  const PartWear all = measure_part(tetrahedra, positions, rates, frame, options, threads);
  return whole_wear({&all, 1});
}

std::optional<std::string> worn(const Wear& fresh, const Wear& now, const WearOptions& options) {
  if (!(now.worst_radius_ratio >= options.radius_ratio_share * fresh.worst_radius_ratio))
    return fmt::format(
        "worst radius ratio {:.3f}, below radius_ratio_share = {:g} of {:.3f} when the mesh was "
        "new",
        now.worst_radius_ratio, options.radius_ratio_share, fresh.worst_radius_ratio);
  if (!(now.worst_jacobian >= options.jacobian_share * fresh.worst_jacobian))
    return fmt::format(
        "worst scaled Jacobian {:.3f}, below jacobian_share = {:g} of {:.3f} when the mesh was new",
        now.worst_jacobian, options.jacobian_share, fresh.worst_jacobian);
  if (!(now.poor_share <= fresh.poor_share + options.poor_share_increase))
    return fmt::format(
        "{:.2f} % of the elements have a radius ratio below {:g}, {:.2f} % when the mesh was new; "
        "poor_share_increase = {:g}",
        100 * now.poor_share, options.poor_radius_ratio, 100 * fresh.poor_share,
        options.poor_share_increase);
  if (!(now.inversion_strain > options.inversion_strain))
    return fmt::format(
        "an element would invert within a strain of {:.4f}, below inversion_strain = {:g}",
        now.inversion_strain, options.inversion_strain);
  return std::nullopt;
}

}  // namespace polyslip::remap
