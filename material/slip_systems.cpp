#include "material/slip_systems.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/rotation.hpp"

namespace polyslip::material {

namespace {

constexpr double same_component = 1e-9;  // of unit vectors; rotations are exact to 1e-15

/// -1, 0, 1 by the first component that differs.
int order(const core::Vec3& a, const core::Vec3& b) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(a[i] - b[i]) > same_component) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

core::Vec3 canonical(const core::Vec3& a) {
  const core::Vec3 unit = a.normalized();
  return order(unit, core::Vec3::Zero()) < 0 ? core::Vec3(-unit) : unit;
}

}  // namespace

std::vector<SlipSystem> slip_systems(const SlipFamily& family) {
  const double size = family.normal.norm() * family.direction.norm();
  if (!(std::abs(family.normal.dot(family.direction)) < same_component * size)) {
    throw core::InternalError("slip_systems: the direction does not lie in the plane");
  }
  std::vector<SlipSystem> systems;
  for (const auto& quaternion : family.rotations) {
    const core::Mat3 rotation = core::to_matrix(quaternion);
    systems.push_back(
        {canonical(rotation * family.normal), canonical(rotation * family.direction)});
  }
  const auto before = [](const SlipSystem& a, const SlipSystem& b) {
    const int planes = order(a.normal, b.normal);
    if (planes != 0) return planes > 0;
    const int sizes = order(a.direction.cwiseAbs(), b.direction.cwiseAbs());
    return sizes != 0 ? sizes < 0 : order(a.direction, b.direction) < 0;
  };
  const auto same = [](const SlipSystem& a, const SlipSystem& b) {
    return order(a.normal, b.normal) == 0 && order(a.direction, b.direction) == 0;
  };
  std::stable_sort(systems.begin(), systems.end(), before);
  systems.erase(std::unique(systems.begin(), systems.end(), same), systems.end());
  return systems;
}

std::vector<SlipSystem> fcc_slip_systems() {
  return slip_systems({core::Vec3(1, 1, 1), core::Vec3(0, 1, -1), core::cubic_symmetries()});
}

const std::array<core::Quaternion, 12>& hexagonal_symmetries() {
  static const auto rotations = [] {
    std::array<core::Quaternion, 12> all;
    for (std::size_t k = 0; k < 6; ++k) {
      const double half_angle = std::numbers::pi / 6 * static_cast<double>(k);
      const double cosine = std::cos(half_angle), sine = std::sin(half_angle);
      all[k] = core::Quaternion(cosine, 0, 0, sine);      // about c
      all[6 + k] = core::Quaternion(0, cosine, sine, 0);  // by 180 degrees, about a basal axis
    }
    return all;
  }();
  return rotations;
}

core::Vec3 hexagonal_normal(double h, double k, double l, double axial_ratio) {
  // reciprocal axes of a1 = x, a2 = (-1/2, sqrt(3)/2, 0), c = axial_ratio z
  return {h, (h + 2 * k) / std::numbers::sqrt3, l / axial_ratio};
}

core::Vec3 hexagonal_direction(double u, double v, double w, double axial_ratio) {
  // u a1 + v a2 - (u + v) a3 + w c with a3 = -a1 - a2
  return {1.5 * u, std::numbers::sqrt3 * (v + u / 2), w * axial_ratio};
}

}  // namespace polyslip::material
