#include "support/grain_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace polyslip::test {

using core::Vec3;

namespace {

constexpr int waves_a_component = 6;
constexpr double largest_step = 0.02;

Vec3 stretch(double strain) { return {std::exp(strain), 1, std::exp(-strain)}; }

}  // namespace

GrainFlow::GrainFlow(const Vec3& size, const Options& options) : size_(size) {
  core::Random random(options.seed, core::Stream::tests);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < waves_a_component; ++i) {
      Wave w;
      w.component = c;
      for (int a = 0; a < 3; ++a) {
        const double length = options.wavelength * random.uniform(0.7, 1.4);
        w.number[a] = 2 * std::numbers::pi / length;
        w.phase[a] = random.uniform(0, 2 * std::numbers::pi);
        if (a == c) continue;
        // cos(t - pi/2) = sin(t); whole half waves between two walls, x1 is none.
        w.phase[a] = -std::numbers::pi / 2;
        if (a == 0) continue;
        const double halves = std::max(1.0, std::round(2 * size[a] / length));
        w.number[a] = std::numbers::pi * halves / size[a];
      }
      w.amplitude = random.normal();
      waves_.push_back(w);
    }
  // Mean square of the gradient by sampling.
  constexpr int samples = 2000;
  constexpr double h = 1e-5;
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    const Vec3 x = Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(size);
    for (int a = 0; a < 3; ++a)
      sum += ((flow(x + h * Vec3::Unit(a)) - flow(x - h * Vec3::Unit(a))) / (2 * h)).squaredNorm();
  }
  for (auto& w : waves_) w.amplitude *= options.strength / std::sqrt(sum / samples);
}

Vec3 GrainFlow::flow(const Vec3& x) const {
  Vec3 u = Vec3::Zero();
  for (const auto& w : waves_) {
    std::array<double, 3> value{}, slope{};
    for (int a = 0; a < 3; ++a) {
      const double t = w.number[a] * x[a] + w.phase[a];
      value[a] = std::cos(t);
      slope[a] = -w.number[a] * std::sin(t);
    }
    // curl (A e_c): component c + 1 gets dA/dx_(c+2), component c + 2 gets -dA/dx_(c+1).
    const int c = w.component, p = (c + 1) % 3, q = (c + 2) % 3;
    u[p] += w.amplitude * value[c] * value[p] * slope[q];
    u[q] -= w.amplitude * value[c] * slope[p] * value[q];
  }
  return u;
}

Vec3 GrainFlow::velocity(const Vec3& x, double strain) const {
  const Vec3 d = stretch(strain);
  return Vec3(x[0], 0, -x[2]) + d.cwiseProduct(flow(x.cwiseQuotient(d)));
}

void GrainFlow::move(mesh::Mesh& mesh, double from, double to) const {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / largest_step - 1e-9)));
  const double h = (to - from) / steps;
  const Vec3 walls = size_.cwiseProduct(stretch(from)), ends = size_.cwiseProduct(stretch(to));
  for (Vec3& x : mesh.nodes) {
    const Vec3 start = x;
    for (int i = 0; i < steps; ++i) {
      const double s = from + i * h;
      const Vec3 k1 = velocity(x, s), k2 = velocity(x + h / 2 * k1, s + h / 2);
      const Vec3 k3 = velocity(x + h / 2 * k2, s + h / 2), k4 = velocity(x + h * k3, s + h);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    for (int a = 0; a < 3; ++a) {
      if (start[a] == 0) x[a] = 0;
      if (a > 0 && std::abs(start[a] - walls[a]) <= 1e-12 * walls[a]) x[a] = ends[a];
    }
  }
}

mesh::QualitySummary scaled_quality(const mesh::Mesh& mesh, const Vec3& scale) {
  mesh::QualitySummary q{1, 0};
  for (const auto& t : mesh.tetrahedra) {
    const auto at = [&](int i) -> Vec3 { return mesh.nodes[t[i]].cwiseProduct(scale); };
    const double rho = mesh::radius_ratio(at(0), at(1), at(2), at(3));
    q.min_radius_ratio = std::min(q.min_radius_ratio, rho);
    q.mean_radius_ratio += rho / mesh.element_count();
  }
  return q;
}

}  // namespace polyslip::test
