#include "results/analysis/sample.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

namespace polyslip::results::analysis {

Sample normalised(Sample sample) {
  if (sample.orientations.empty() || sample.weights.size() != sample.size())
    throw core::InternalError(fmt::format("texture: {} orientations with {} weights", sample.size(),
                                          sample.weights.size()));
  double sum = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (!(sample.weights[i] >= 0) || !std::isfinite(sample.weights[i]) ||
        !sample.orientations[i].coeffs().allFinite())
      throw core::InternalError(
          fmt::format("texture: orientation {} has the weight {} or is not "
                      "finite",
                      i, sample.weights[i]));
    sum += sample.weights[i];
  }
  if (!(sum > 0)) throw core::InternalError("texture: the weights add up to zero");
  for (double& w : sample.weights) w /= sum;
  return sample;
}

Sample equally_weighted(std::vector<core::Quaternion> orientations) {
  std::vector<double> weights(orientations.size(), 1.0);
  return normalised({std::move(orientations), std::move(weights)});
}

const std::vector<core::Quaternion>& sample_symmetries(SampleSymmetry symmetry) {
  static const std::vector<core::Quaternion> none{{1, 0, 0, 0}};
  static const std::vector<core::Quaternion> orthorhombic{
      {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  return symmetry == SampleSymmetry::none ? none : orthorhombic;
}

}  // namespace polyslip::results::analysis
