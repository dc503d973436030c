#include "results/analysis/components.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/rotation.hpp"
#include "core/texture.hpp"

namespace polyslip::results::analysis {
namespace {

using core::Quaternion;
using core::Vec3;

constexpr double same = 1e-6;  // rad
// Of the ridge, in degrees: first coarsely, then about the best place.
constexpr double search_reach = 15, coarse_step = 2.5, fine_step = 0.5;

Component component_of(const core::NamedOrientation& named) {
  Component c{named.name, {}};
  const Quaternion q = core::miller_orientation(named.plane, named.direction);
  for (const Quaternion& turn : sample_symmetries(SampleSymmetry::orthorhombic)) {
    const Quaternion variant = turn * q;
    const bool known = std::any_of(c.variants.begin(), c.variants.end(), [&](const auto& v) {
      return core::disorientation_angle(v, variant) < same;
    });
    if (!known) c.variants.push_back(variant);
  }
  return c;
}

double averaged(const Odf& odf, const Vec3& bunge) {
  if (odf.symmetry() == SampleSymmetry::orthorhombic) return odf.at(core::from_bunge(bunge));
  double sum = 0;
  for (const Quaternion& turn : sample_symmetries(SampleSymmetry::orthorhombic))
    sum += odf.at(turn * core::from_bunge(bunge));
  return sum / 4;
}

/// Copper, s and brass where they lie on one line of Bunge's angles [degrees].
const std::array<Vec3, 3> corners{
    Vec3{90, 35.2643897, 45}, Vec3{58.9803442, 36.6992252, 63.4349488}, Vec3{35.2643897, 45, 90}};

Vec3 ideal_place(double phi2) {
  const std::size_t part = phi2 <= corners[1][2] ? 0 : 1;
  const Vec3 &from = corners[part], &to = corners[part + 1];
  return from + (phi2 - from[2]) / (to[2] - from[2]) * (to - from);
}

/// The largest of f on a square grid of the section about `centre`.
void climb(const Odf& odf, const Vec3& centre, double reach, double step, FibrePoint& point) {
  const int n = static_cast<int>(std::lround(reach / step));
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j) {
      const Vec3 place = centre + Vec3(i * step, j * step, 0);
      const double f = averaged(odf, place);
      if (f <= point.ridge_intensity) continue;
      point.ridge_intensity = f;
      point.ridge = place;
    }
}

FibrePoint fibre_point(const Odf& odf, double phi2) {
  FibrePoint point;
  point.phi2 = phi2;
  point.ideal = point.ridge = ideal_place(phi2);
  point.ideal_intensity = point.ridge_intensity = averaged(odf, point.ideal);
  climb(odf, point.ideal, search_reach, coarse_step, point);
  climb(odf, Vec3(point.ridge), coarse_step, fine_step, point);
  return point;
}

}  // namespace

const std::vector<Component>& rolling_components() {
  static const std::vector<Component> list = [] {
    std::vector<Component> components;
    for (const char* name : {"cube", "goss", "brass", "s", "copper", "dillamore", "rotated-cube"})
      for (const auto& named : core::named_orientations())
        if (named.name == name) components.push_back(component_of(named));
    return components;
  }();
  return list;
}

double intensity(const Odf& odf, const Component& component) {
  double sum = 0;
  for (const Quaternion& variant : component.variants) sum += odf.at(variant);
  return sum / static_cast<double>(component.variants.size());
}

double volume_fraction(const Sample& sample, const Component& component, double angle) {
  double inside = 0, total = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    total += sample.weights[i];
    const bool near = std::any_of(
        component.variants.begin(), component.variants.end(), [&](const Quaternion& variant) {
          return core::disorientation_angle(sample.orientations[i], variant) <= angle;
        });
    if (near) inside += sample.weights[i];
  }
  return inside / total;
}

// The share of all rotations by up to w is (w - sin w) / pi; 24 of them are one crystal.
double random_volume_fraction(const Component& component, double angle) {
  return 24 * static_cast<double>(component.variants.size()) * (angle - std::sin(angle)) /
         std::numbers::pi;
}

std::vector<FibrePoint> beta_fibre(const Odf& odf, int threads) {
  std::vector<FibrePoint> points(10);
  core::parallel_for(core::thread_count(threads), points.size(), [&](std::size_t i) {
    points[i] = fibre_point(odf, 45 + 5 * static_cast<double>(i));
  });
  return points;
}

}  // namespace polyslip::results::analysis
