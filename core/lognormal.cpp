#include "core/lognormal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace polyslip::core {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
  if (!(p > 0 && p < 1))
    throw InternalError(fmt::format("normal quantile of {}: must lie between 0 and 1", p));
  // Bisection to the last bit: erfc holds its relative accuracy in the lower tail, so that is where
  // the search is made.
  const double tail = std::min(p, 1 - p);
  double low = -40, high = 0;
  while (true) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (normal_cdf(middle) < tail ? low : high) = middle;
  }
  return p <= 0.5 ? high : -high;
}

Lognormal::Lognormal(double mean, double standard_deviation) {
  if (!(mean > 0 && std::isfinite(mean) && standard_deviation > 0 &&
        std::isfinite(standard_deviation)))
    throw InputError(
        fmt::format("lognormal distribution of mean {} and standard deviation {}: both "
                    "must be positive",
                    mean, standard_deviation));
  const double ratio = standard_deviation / mean;
  sigma_ = std::sqrt(std::log1p(ratio * ratio));
  mu_ = std::log(mean) - sigma_ * sigma_ / 2;
}

double Lognormal::cdf(double x) const {
  return x > 0 ? normal_cdf((std::log(x) - mu_) / sigma_) : 0;
}

double Lognormal::density(double x) const {
  if (!(x > 0)) return 0;
  const double z = (std::log(x) - mu_) / sigma_;
  return std::exp(-z * z / 2) / (x * sigma_ * std::sqrt(2 * std::numbers::pi));
}

double Lognormal::quantile(double p) const { return std::exp(mu_ + sigma_ * normal_quantile(p)); }

double Lognormal::moment(double k) const { return std::exp(k * mu_ + k * k * sigma_ * sigma_ / 2); }

double kolmogorov_smirnov(std::vector<double> sample, const std::function<double(double)>& cdf) {
  if (sample.empty()) throw InternalError("Kolmogorov-Smirnov distance of an empty sample");
  std::sort(sample.begin(), sample.end());
  const double n = static_cast<double>(sample.size());
  double distance = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double expected = cdf(sample[i]), rank = static_cast<double>(i);
    distance = std::max({distance, expected - rank / n, (rank + 1) / n - expected});
    if (std::isnan(expected) || std::isnan(sample[i])) return expected + sample[i];
  }
  return distance;
}

}  // namespace polyslip::core
