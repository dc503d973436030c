#pragma once
// The kernel that makes a density of single orientations, and the density of its poles.

#include <cstddef>
#include <vector>

namespace polyslip::results::analysis {

/// De la Vallee Poussin's kernel K(w) = C cos^(2 kappa)(w/2) of the rotation angle w, in times
/// random: C = B(3/2, 1/2) / B(3/2, kappa + 1/2) makes its mean over all rotations 1
/// (docs/texture.md, (T.2); Schaeben 1997). Half its maximum is reached at w = half_width.
class Kernel {
 public:
  /// half_width [rad] in (0, pi/2]; InternalError otherwise.
  explicit Kernel(double half_width);

  double half_width() const { return half_width_; }
  /// kappa of core::kernel_exponent
  double exponent() const { return kappa_; }
  /// C, the value at w = 0
  double peak() const { return peak_; }

  /// K at cos(w/2) = `cosine` (its sign does not matter).
  double rotation(double cosine) const;
  /// Density of the poles of one crystal direction, in times random, at the angle whose cosine is
  /// given from the direction's place: (kappa + 1) ((1 + cosine)/2)^kappa, (T.5). Its mean over
  /// the sphere is 1.
  double pole(double cosine) const;

 private:
  double half_width_, kappa_, peak_;
};

/// x^exponent for x from where it is `negligible` up to 1, by Taylor's series of fourth order about
/// the nearest of 2,000 places: to 1e-10 of itself, several times faster than std::pow.
class PowerTable {
 public:
  static constexpr double negligible = 1e-8;
  explicit PowerTable(double exponent);

  /// The x at which the power is `negligible`.
  double least() const { return least_; }
  /// least() <= x <= 1; a little above 1 will do.
  double operator()(double x) const {
    const Node& node = nodes_[static_cast<std::size_t>((x - least_) * per_length_ + 0.5)];
    const double d = (x - node.place) * node.inverse;
    return node.value *
           (1 + d * (c_[0] + d * (c_[1] + d * (c_[2] + d * c_[3]))));  // binomial coefficients
  }

 private:
  struct Node {
    double place, inverse, value;
  };
  double least_, per_length_;
  double c_[4];
  std::vector<Node> nodes_;
};

}  // namespace polyslip::results::analysis
