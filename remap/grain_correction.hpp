#pragma once
// Gives each grain back what transport by points took from it.

#include "mesh/snapshot.hpp"

namespace polyslip::remap {

/// Changes the fields at the quadrature points of `fresh` so that each grain has its mean
/// orientation, its spread and its means of scalars (Transport::element_average) in `old`.
/// Orientations: q = m exp(k d) for points with m_fresh exp(d), d the rotation vector from the
/// grain's mean, k the ratio of spreads (R.4); repeated, as the mean of scaled deviations is the
/// mean to second order only. Scalars: scaled by the ratio of the means, and kept within the old
/// extremes of the grain.
void correct_grains(const mesh::Snapshot& old, mesh::Snapshot& fresh, int threads);

}  // namespace polyslip::remap
