#include "results/analysis/pole_figure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rotation.hpp"
#include "results/analysis/moment_cells.hpp"

namespace polyslip::results::analysis {
namespace {

using core::Vec3;
using Cells = MomentCells<3>;

constexpr double cells_a_half_width = 4;
constexpr int cells_a_group = 4;

Cells gather(const std::vector<Vec3>& directions, const std::vector<double>& weights,
             double half_width) {
  const double edge = half_width / cells_a_half_width;
  std::vector<CellKey> keys;
  keys.reserve(directions.size());
  for (const Vec3& d : directions)
    keys.push_back({static_cast<int>(std::floor(d[0] / edge)),
                    static_cast<int>(std::floor(d[1] / edge)),
                    static_cast<int>(std::floor(d[2] / edge))});
  return {directions, weights, keys, cells_a_group};
}

/// Sum of the kernel's poles about all that is in the cells.
double density(const Cells& cells, const Kernel& kernel, const PowerTable& power,
               const Vec3& direction) {
  const double kappa = kernel.exponent();
  // P and its second derivative by the cosine t: P'' = P kappa (kappa - 1) / (1 + t)^2.
  const auto f = [&](double t, double& second) {
    const double value = power((1 + t) / 2);
    second = value * kappa * (kappa - 1) / ((1 + t) * (1 + t));
    return value;
  };
  return (kappa + 1) * cells.sum<false>(direction, 2 * power.least() - 1, f);
}

}  // namespace

std::vector<Vec3> crystal_family(const std::array<int, 3>& hkl) {
  const Vec3 h = Vec3(hkl[0], hkl[1], hkl[2]).normalized();
  std::vector<Vec3> family;
  for (const auto& s : core::cubic_symmetries())
    for (const double sign : {1.0, -1.0}) {
      const Vec3 v = sign * (s * h);
      const bool known = std::any_of(family.begin(), family.end(),
                                     [&](const Vec3& w) { return (v - w).norm() < 1e-9; });
      if (!known) family.push_back(v);
    }
  return family;
}

struct PoleFigure::Data {
  Kernel kernel;
  SampleSymmetry symmetry;
  Cells cells;
  PowerTable power = PowerTable(kernel.exponent());
};

PoleFigure::PoleFigure(const Sample& sample, const std::array<int, 3>& hkl, double half_width,
                       SampleSymmetry symmetry) {
  const Sample s = normalised(sample);
  const auto family = crystal_family(hkl);
  std::vector<Vec3> poles;
  std::vector<double> weights;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (const Vec3& h : family) {
      const Vec3 pole = s.orientations[i] * h;
      if (pole[2] < 0) continue;  // its opposite is there
      poles.push_back(pole);
      weights.push_back(2 * s.weights[i] / static_cast<double>(family.size()));
    }
  data_.reset(new Data{Kernel(half_width), symmetry, gather(poles, weights, half_width)});
}
PoleFigure::~PoleFigure() = default;
PoleFigure::PoleFigure(PoleFigure&&) noexcept = default;

double PoleFigure::at(const Vec3& direction) const {
  const Vec3 d = direction.normalized();
  const auto& turns = sample_symmetries(data_->symmetry);
  double sum = 0;
  for (const auto& turn : turns) {
    const Vec3 r = turn * d;
    sum += density(data_->cells, data_->kernel, data_->power, r) +
           density(data_->cells, data_->kernel, data_->power, -r);
  }
  return sum / (2 * static_cast<double>(turns.size()));
}

struct InversePoleFigure::Data {
  Kernel kernel;
  Cells cells;
  PowerTable power = PowerTable(kernel.exponent());
};

InversePoleFigure::InversePoleFigure(const Sample& sample, const Vec3& sample_direction,
                                     double half_width, SampleSymmetry symmetry) {
  const Sample s = normalised(sample);
  const auto& turns = sample_symmetries(symmetry);
  std::vector<Vec3> directions;
  std::vector<double> weights;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (const auto& turn : turns) {
      directions.push_back(in_standard_triangle(s.orientations[i].conjugate() *
                                                (turn * sample_direction.normalized())));
      weights.push_back(s.weights[i] / static_cast<double>(turns.size()));
    }
  data_.reset(new Data{Kernel(half_width), gather(directions, weights, half_width)});
}
InversePoleFigure::~InversePoleFigure() = default;
InversePoleFigure::InversePoleFigure(InversePoleFigure&&) noexcept = default;

double InversePoleFigure::at(const Vec3& direction) const {
  const Vec3 d = direction.normalized();
  double sum = 0;
  for (const auto& s : core::cubic_symmetries())
    sum += density(data_->cells, data_->kernel, data_->power, s * d) +
           density(data_->cells, data_->kernel, data_->power, -(s * d));
  return sum / 48;
}

Vec3 in_standard_triangle(const Vec3& direction) {
  Vec3 d = direction.normalized().cwiseAbs();
  std::sort(d.begin(), d.end());
  return {d[1], d[0], d[2]};
}

Eigen::Vector2d equal_area(const Vec3& direction) {
  const Vec3 d = direction.normalized();
  return d.head<2>() / std::sqrt(1 + d[2]);
}

Vec3 from_equal_area(const Eigen::Vector2d& place) {
  const double z = 1 - place.squaredNorm();
  return Vec3(place[0] * std::sqrt(1 + z), place[1] * std::sqrt(1 + z), z).normalized();
}

Vec3 triangle_colour(const Vec3& crystal_direction) {
  // In the corners' basis d = a [001] + b [011] + c [111] (the triangle's own order of axes).
  const Vec3 d = in_standard_triangle(crystal_direction);
  const Vec3 share(d[2] - d[0], (d[0] - d[1]) * std::numbers::sqrt2, d[1] * std::numbers::sqrt3);
  return 255 * share / share.maxCoeff();
}

Vec3 inverse_pole_colour(const core::Quaternion& q, const Vec3& sample_direction) {
  return triangle_colour(q.conjugate() * sample_direction);
}

}  // namespace polyslip::results::analysis
