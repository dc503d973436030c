#include "material/slip_systems.hpp"

#include <algorithm>
#include <cmath>

#include "core/rotation.hpp"

namespace polyslip::material {

namespace {

constexpr double same_direction = 1e-9;  // |1 - |cos|| below which two unit vectors are parallel

bool parallel(const core::Vec3& a, const core::Vec3& b) {
  return std::abs(std::abs(a.dot(b)) - 1.0) < same_direction;
}

}  // namespace

std::vector<SlipSystem> slip_systems(const SlipSystem& seed,
                                     std::span<const core::Quaternion> rotations) {
  std::vector<SlipSystem> systems;
  for (const auto& quaternion : rotations) {
    const core::Mat3 rotation = core::to_matrix(quaternion);
    const SlipSystem candidate{(rotation * seed.normal).normalized(),
                               (rotation * seed.direction).normalized()};
    const bool known = std::any_of(systems.begin(), systems.end(), [&](const SlipSystem& system) {
      return parallel(system.normal, candidate.normal) &&
             parallel(system.direction, candidate.direction);
    });
    if (!known) systems.push_back(candidate);
  }
  return systems;
}

std::vector<SlipSystem> fcc_slip_systems() {
  return slip_systems({core::Vec3(1, 1, 1), core::Vec3(0, 1, -1)}, core::cubic_symmetries());
}

}  // namespace polyslip::material
