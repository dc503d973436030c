#pragma once
// The orientation distribution function of a sample of cubic crystals.

#include <memory>
#include <span>
#include <vector>

#include "results/analysis/kernel.hpp"
#include "results/analysis/sample.hpp"

namespace polyslip::results::analysis {

/// f(g) = sum_i w_i 1/24 sum_S K(angle between g and g_i S), in times random (docs/texture.md,
/// (T.1)); with a sample symmetry the mean of f(R g) over its rotations R. Orientations are
/// gathered in cells of 0.4 half-widths with their second moments; that changes f by less
/// than 1e-3 of its maximum, and nothing where orientations stand alone.
class Odf {
 public:
  /// half_width [rad]; the sample as for `normalised`.
  Odf(const Sample& sample, double half_width, SampleSymmetry symmetry = SampleSymmetry::none);
  ~Odf();
  Odf(Odf&&) noexcept;
  Odf& operator=(Odf&&) noexcept;

  double at(const core::Quaternion& q) const;
  /// Many at once, on `threads` threads (0: one a core).
  std::vector<double> at(std::span<const core::Quaternion> orientations, int threads = 0) const;

  const Kernel& kernel() const;
  SampleSymmetry symmetry() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

struct OdfIntegrals {
  double mean = 0;           ///< of f over all rotations: 1
  double texture_index = 0;  ///< mean of f^2: 1 for random, larger for strong textures
};

/// By the trapezium rule in phi1 and phi2, Gauss's in cos Phi, steps of two thirds of a half-width:
/// good to 1e-5.
OdfIntegrals integrals(const Odf& odf, int threads = 0);

/// Nodes and weights of Gauss's rule on [0, 1]; weights add up to 1.
std::vector<std::pair<double, double>> gauss_rule(int points);

}  // namespace polyslip::results::analysis
