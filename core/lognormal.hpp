#pragma once
// The lognormal distribution, and how far a sample is from a distribution.

#include <functional>
#include <vector>

namespace polyslip::core {

/// Standard normal distribution function, and its inverse for 0 < p < 1.
double normal_cdf(double z);
double normal_quantile(double p);

/// Distribution of exp(mu + sigma z), z standard normal.
class Lognormal {
 public:
  /// From mean and standard deviation, both positive: sigma^2 = ln(1 + (sd/mean)^2),
  /// mu = ln(mean) - sigma^2/2. InputError otherwise.
  Lognormal(double mean, double standard_deviation);

  double mu() const { return mu_; }
  double sigma() const { return sigma_; }
  double cdf(double x) const;       ///< 0 for x <= 0
  double density(double x) const;   ///< 0 for x <= 0
  double quantile(double p) const;  ///< 0 < p < 1
  /// E[X^k]
  double moment(double k) const;

 private:
  double mu_, sigma_;
};

/// Kolmogorov-Smirnov distance: the largest difference between the sample's distribution function
/// and `cdf`, over both sides of each step. `sample` in any order, not empty.
double kolmogorov_smirnov(std::vector<double> sample, const std::function<double(double)>& cdf);

}  // namespace polyslip::core
