#include "core/texture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/rotation.hpp"

namespace polyslip::core {
namespace {

/// How many of `count` each component gets.
std::vector<int> whole_shares(const std::vector<TextureComponent>& components, int count) {
  double total = 0;
  for (const auto& c : components) {
    if (!(c.share > 0))
      throw InternalError("random_texture: a share of " + std::to_string(c.share));
    total += c.share;
  }
  std::vector<int> whole;
  std::vector<double> remainder;
  for (const auto& c : components) {
    const double part = count * c.share / total;
    whole.push_back(static_cast<int>(std::floor(part)));
    remainder.push_back(part - whole.back());
  }
  std::vector<std::size_t> order(components.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](auto a, auto b) { return remainder[a] > remainder[b]; });
  int left = count - std::accumulate(whole.begin(), whole.end(), 0);
  for (std::size_t i = 0; left > 0; i = (i + 1) % order.size(), --left) ++whole[order[i]];
  return whole;
}

/// A rotation by an angle uniform in [0, 2 pi) about a unit axis.
Quaternion random_turn(Random& random, const Vec3& axis) {
  return exp_axial(axis * random.uniform(-std::numbers::pi, std::numbers::pi));
}

}  // namespace

Quaternion miller_orientation(const Vec3& plane, const Vec3& direction) {
  const Vec3 z = plane.normalized();
  const Vec3 x = direction - direction.dot(z) * z;
  if (!(plane.norm() > 0) || !(x.norm() > 1e-9 * direction.norm()))
    throw InputError("a plane and a direction must not be zero or parallel");
  // The rows of Q are the sample's axes in the crystal frame.
  Mat3 q;
  q.row(0) = x.normalized().transpose();
  q.row(2) = z.transpose();
  q.row(1) = z.cross(x.normalized()).transpose();
  return from_matrix(q);
}

const std::vector<NamedOrientation>& named_orientations() {
  static const std::vector<NamedOrientation> list{
      {"cube", {0, 0, 1}, {1, 0, 0}},        {"goss", {0, 1, 1}, {1, 0, 0}},
      {"brass", {0, 1, 1}, {2, -1, 1}},      {"copper", {1, 1, 2}, {-1, -1, 1}},
      {"s", {1, 2, 3}, {6, 3, -4}},          {"dillamore", {4, 4, 11}, {11, 11, -8}},
      {"rotated-cube", {0, 0, 1}, {1, 1, 0}}};
  return list;
}

double kernel_exponent(double half_width) {
  return -std::numbers::ln2 / (2 * std::log(std::cos(half_width / 2)));
}

double random_gamma(Random& random, double shape) {
  // With one less of shape below 1, by the identity Gamma(a) = Gamma(a + 1) U^(1/a).
  if (shape < 1) return random_gamma(random, shape + 1) * std::pow(1 - random.uniform(), 1 / shape);
  const double d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  while (true) {
    const double x = random.normal(), t = 1 + c * x, v = t * t * t;
    const double u = 1 - random.uniform();  // in (0, 1]
    if (v > 0 && std::log(u) < 0.5 * x * x + d * (1 - v + std::log(v))) return d * v;
  }
}

// With three normal numbers n, X = n.n/2 has the distribution Gamma(3/2), and X / (X + Y) that of
// Beta(3/2, kappa + 1/2) if Y has Gamma(kappa + 1/2); the direction of n is uniform.
Quaternion random_spread(Random& random, double kappa) {
  double x = random.normal(), y = random.normal(), z = random.normal();
  const double rest = random_gamma(random, kappa + 0.5);
  return Quaternion(std::sqrt(2 * rest), x, y, z).normalized();
}

Quaternion random_orientation(Random& random, const TextureComponent& component) {
  if (component.kind == TextureComponent::Kind::uniform) return random.rotation();
  Quaternion q = component.orientation;
  if (component.kind == TextureComponent::Kind::fibre) {
    const Vec3 along = component.sample.normalized();
    q = random_turn(random, along) *
        Quaternion::FromTwoVectors(component.crystal.normalized(), along);
  }
  if (component.half_width > 0)
    q = random_spread(random, kernel_exponent(component.half_width)) * q;
  if (component.orthorhombic) {
    constexpr std::array<std::array<double, 4>, 4> half_turns{
        {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    const auto& t = half_turns[random.index(4)];
    q = Quaternion(t[0], t[1], t[2], t[3]) * q;
  }
  return q.normalized();
}

std::vector<Quaternion> random_texture(Random& random,
                                       const std::vector<TextureComponent>& components, int count) {
  if (components.empty()) throw InternalError("random_texture: no components");
  const std::vector<int> whole = whole_shares(components, count);
  std::vector<Quaternion> orientations;
  for (std::size_t c = 0; c < components.size(); ++c)
    for (int i = 0; i < whole[c]; ++i)
      orientations.push_back(random_orientation(random, components[c]));
  for (std::size_t i = orientations.size(); i > 1; --i)
    std::swap(orientations[i - 1], orientations[random.index(i)]);
  return orientations;
}

}  // namespace polyslip::core
