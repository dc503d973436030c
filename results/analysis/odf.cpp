#include "results/analysis/odf.hpp"

#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/rotation.hpp"
#include "results/analysis/moment_cells.hpp"

namespace polyslip::results::analysis {
namespace {

using core::Quaternion;
using Cells = MomentCells<4>;

constexpr double cells_a_half_width = 2.5;
constexpr int cells_a_group = 4;  // along each axis

Cells gather(const Sample& sample, double half_width) {
  const Sample s = normalised(sample);
  std::vector<Eigen::Vector4d> vectors;
  std::vector<CellKey> keys;
  vectors.reserve(s.size());
  keys.reserve(s.size());
  const double edge = half_width / cells_a_half_width;
  for (const Quaternion& q : s.orientations) {
    const Quaternion f = core::fundamental_variant(q.normalized());
    const double half_sine = f.vec().norm();
    const core::Vec3 turn =
        half_sine > 0 ? core::Vec3(f.vec() * (core::rotation_angle(f) / half_sine)) : f.vec();
    keys.push_back({static_cast<int>(std::floor(turn[0] / edge)),
                    static_cast<int>(std::floor(turn[1] / edge)),
                    static_cast<int>(std::floor(turn[2] / edge))});
    vectors.push_back(f.coeffs());
  }
  return {vectors, s.weights, keys, cells_a_group};
}

}  // namespace

struct Odf::Data {
  Kernel kernel;
  SampleSymmetry symmetry;
  Cells cells;
  PowerTable power;  ///< s^kappa of s = cos^2(w/2)
};

Odf::Odf(const Sample& sample, double half_width, SampleSymmetry symmetry)
    : data_(new Data{Kernel(half_width), symmetry, gather(sample, half_width),
                     PowerTable(Kernel(half_width).exponent())}) {}
Odf::~Odf() = default;
Odf::Odf(Odf&&) noexcept = default;
Odf& Odf::operator=(Odf&&) noexcept = default;

const Kernel& Odf::kernel() const { return data_->kernel; }
SampleSymmetry Odf::symmetry() const { return data_->symmetry; }

double Odf::at(const Quaternion& q) const {
  const double kappa = data_->kernel.exponent();
  // K and its second derivative by t = cos(w/2): K'' = K 2 kappa (2 kappa - 1) / t^2.
  const auto f = [&](double t, double& second) {
    const double square = t * t, value = data_->power(square);
    second = value * 2 * kappa * (2 * kappa - 1) / square;
    return value;
  };
  const auto& turns = sample_symmetries(data_->symmetry);
  const double least = std::sqrt(data_->power.least());
  double sum = 0;
  for (const Quaternion& turn : turns)
    for (const Quaternion& s : core::cubic_symmetries())
      sum += data_->cells.sum<true>((turn * q * s).coeffs(), least, f);
  return data_->kernel.peak() * sum / (24 * static_cast<double>(turns.size()));
}

std::vector<double> Odf::at(std::span<const Quaternion> orientations, int threads) const {
  std::vector<double> values(orientations.size());
  core::parallel_for(core::thread_count(threads), orientations.size(),
                     [&](std::size_t i) { values[i] = at(orientations[i]); });
  return values;
}

std::vector<std::pair<double, double>> gauss_rule(int points) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < points; ++i) {
    // Newton on Legendre's polynomial from Tricomi's guess.
    double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double p = x, before = 1;
      for (int k = 2; k <= points; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      if (points == 1) before = 1;
      slope = points * (x * p - before) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.emplace_back((1 - x) / 2, 1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

// f has the period 90 degrees in phi2 and f(phi1, 180 - Phi, phi2) = f(phi1 + 180, Phi, -phi2), so
// that Phi up to 90 degrees will do.
OdfIntegrals integrals(const Odf& odf, int threads) {
  const double step = odf.kernel().half_width() / 1.5;
  const int n2 = static_cast<int>(std::ceil(std::numbers::pi / 2 / step)), n1 = 4 * n2;
  const auto rule = gauss_rule(n2 + 6);
  std::vector<Quaternion> points;
  std::vector<double> weights;
  for (const auto& [cosine, weight] : rule)
    for (int j = 0; j < n2; ++j)
      for (int i = 0; i < n1; ++i) {
        points.push_back(core::from_bunge(
            {360.0 * i / n1, std::acos(cosine) * core::degrees_per_radian, 90.0 * j / n2}));
        weights.push_back(weight / (n1 * n2));
      }
  const auto values = odf.at(points, threads);
  OdfIntegrals result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.mean += weights[i] * values[i];
    result.texture_index += weights[i] * values[i] * values[i];
  }
  return result;
}

}  // namespace polyslip::results::analysis
