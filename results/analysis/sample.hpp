#pragma once
// Orientations with weights: what every texture is made of.

#include <vector>

#include "core/types.hpp"

namespace polyslip::results::analysis {

/// Symmetry of the sample that a texture is given: none, or half turns about x, y and z (rolling),
/// over which densities are averaged.
enum class SampleSymmetry { none, orthorhombic };

/// Orientations (core/rotation.hpp) with their shares of the volume.
struct Sample {
  std::vector<core::Quaternion> orientations;
  std::vector<double> weights;  ///< as many, not negative, of any sum but zero (volumes)

  std::size_t size() const { return orientations.size(); }
};

/// The sample with weights that add up to 1. InternalError if there is nothing in it, a value is
/// not finite, or the weights are not as above.
Sample normalised(Sample sample);

/// Equal weights.
Sample equally_weighted(std::vector<core::Quaternion> orientations);

/// Rotations of the sample, identity first: one, or the four of orthorhombic symmetry. They act
/// from the left.
const std::vector<core::Quaternion>& sample_symmetries(SampleSymmetry symmetry);

}  // namespace polyslip::results::analysis
