#pragma once
// The criterion O of a grain's mesh, eqs. (4) to (7) of the paper, from its elements one by one.

#include <algorithm>
#include <cmath>

namespace polyslip::mesh {

/// alpha 0.2, beta 0.1. Without elements, or with one that is flat or inverted, all are 0.
class QualityCriterion {
 public:
  /// `element_size`: c_l
  explicit QualityCriterion(double element_size) : element_size_(element_size) {}

  /// `length`: l_i, the mean of the element's edge lengths.
  void add(double radius_ratio, double length) { add(radius_ratio, length, element_size_); }
  /// With a c_l of the element's own.
  void add(double radius_ratio, double length, double element_size) {
    ++count_;
    if (!(radius_ratio > 0)) {
      flat_ = true;
      return;
    }
    const double power = std::pow(radius_ratio, beta);
    // rho = 1 up to rounding: sigma = 1, as the exponent's limit is 0.
    if (power < 1) log_distortion_ += std::exp(power / (power - 1)) * std::log(radius_ratio);
    sizes_ += std::min(length / element_size, element_size / length);
  }

  /// O_dis, eq. (6)
  double distortion() const { return valid() ? std::exp(log_distortion_) : 0; }
  /// O_size, eq. (7)
  double size() const { return valid() ? std::pow(mean_size(), 3) : 0; }
  /// O, eq. (5)
  double value() const {
    if (!valid()) return 0;
    return std::exp((1 - alpha) * log_distortion_) * std::pow(mean_size(), 3 * alpha);
  }

 private:
  static constexpr double alpha = 0.2;  // weight of the sizes, eq. (5)
  static constexpr double beta = 0.1;   // eq. (6)

  bool valid() const { return count_ > 0 && !flat_; }
  double mean_size() const { return sizes_ / static_cast<double>(count_); }

  double element_size_;
  long count_ = 0;
  bool flat_ = false;
  double log_distortion_ = 0, sizes_ = 0;
};

}  // namespace polyslip::mesh
