#include "results/analysis/kernel.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "core/texture.hpp"

namespace polyslip::results::analysis {
namespace {

/// B(3/2, 1/2) / B(3/2, kappa + 1/2)
double peak_of(double kappa) {
  const double log_beta = std::lgamma(1.5) + std::lgamma(kappa + 0.5) - std::lgamma(kappa + 2);
  return std::numbers::pi / 2 * std::exp(-log_beta);
}

}  // namespace

Kernel::Kernel(double half_width) : half_width_(half_width) {
  if (!(half_width > 0 && half_width <= std::numbers::pi / 2))
    throw core::InternalError("Kernel: a half-width of " + std::to_string(half_width) + " rad");
  kappa_ = core::kernel_exponent(half_width);
  peak_ = peak_of(kappa_);
}

double Kernel::rotation(double cosine) const { return peak_ * std::pow(cosine * cosine, kappa_); }

double Kernel::pole(double cosine) const {
  return (kappa_ + 1) * std::pow((1 + cosine) / 2, kappa_);
}

PowerTable::PowerTable(double exponent) : least_(std::pow(negligible, 1 / exponent)) {
  constexpr int intervals = 2000;
  per_length_ = intervals / (1 - least_);
  double coefficient = 1;
  for (int k = 0; k < 4; ++k) c_[k] = coefficient *= (exponent - k) / (k + 1);
  for (int i = 0; i <= intervals + 1; ++i) {
    const double place = least_ + i / per_length_;
    nodes_.push_back({place, 1 / place, std::pow(place, exponent)});
  }
}

}  // namespace polyslip::results::analysis
