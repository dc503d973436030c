#pragma once
// How far orientations spread within grains, and how grains turn (section 3.3 of the paper).

#include <vector>

#include "results/analysis/run_sample.hpp"

namespace polyslip::results::analysis {

/// One grain in one state; angles in degrees. Elements count by their volumes.
struct GrainSpread {
  long elements = 0;
  double volume = 0;
  core::Quaternion mean = core::Quaternion::Identity();  ///< continuous from state to state
  double spread = 0;      ///< mean disorientation from the mean orientation
  double deviation = 0;   ///< standard deviation of that disorientation
  double largest = 0;     ///< largest disorientation
  double rotation = 0;    ///< angle of the mean from that of the first state
  double bimodality = 0;  ///< Sarle's coefficient along the principal axis of the spread
};

/// A grain has one mode if Sarle's coefficient is not above that of a uniform distribution.
inline constexpr double one_mode_bound = 5.0 / 9;

/// The spreads of every grain. `before`: those of an earlier state of the same grains, to whose
/// means the new ones are continuous; `first`: those from which rotations count. Both may be empty:
/// the mean is then in the fundamental region, the rotation 0.
std::vector<GrainSpread> grain_spreads(const RunSample& sample,
                                       const std::vector<GrainSpread>& before,
                                       const std::vector<GrainSpread>& first);

/// Mean of orientations as in the paper (quaternions' eigenvector mean, by volume): each by its
/// variant nearest to the mean, which is found by repeating that from `reference`.
core::Quaternion settled_mean(const Sample& sample, const core::Quaternion& reference);

/// Rotation vectors [degrees, sample axes] that take the mean to each orientation, by the shortest
/// way of all variants.
std::vector<core::Vec3> disorientation_vectors(const Sample& sample, const core::Quaternion& mean);

/// Weighted Sarle's coefficient (skewness^2 + 1) / kurtosis of the vectors' components along their
/// principal axis: 1/3 for a normal, 5/9 for a uniform distribution, 1 for two places; 0 if there
/// is no spread.
double bimodality(const std::vector<core::Vec3>& vectors, const std::vector<double>& weights);

/// Linear correlation coefficient of two lists; NaN for fewer than two pairs or no scatter.
double correlation(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace polyslip::results::analysis
