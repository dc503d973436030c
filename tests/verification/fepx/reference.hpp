#pragma once
// Values at the elements' centroids: of tests/data/fepx, and of a state of ours; and how far they
// are apart.

#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/snapshot.hpp"

namespace polyslip::tests {

/// [elements] each; stress: xx yy zz yz zx xy, MPa, sample axes; g: [elements][1 or 12], MPa.
struct CentroidValues {
  std::vector<core::Vec3> centroid;  ///< before loading
  std::vector<core::Quaternion> orientation;
  std::vector<core::Vec6> stress;
  std::vector<std::vector<double>> g;
};

/// tests/data/fepx/NAME.txt.gz
CentroidValues read_reference(const std::string& name);

/// The point at the centroid of a state of fifteen points an element, or the mean with the rule's
/// weights; `start`: the state at strain zero, of the same mesh.
CentroidValues centroid_values(const mesh::Snapshot& state, const mesh::Snapshot& start);

struct Differences {
  double mean_angle = 0, largest_angle = 0;  ///< degrees, over the elements
  /// Volume-weighted mean of the von Mises norm of the difference over that of the reference.
  double deviator = 0;
  std::vector<double> g;  ///< of each component: volume-weighted mean of |g/g_reference - 1|
  double pressure = 0, reference_pressure = 0;  ///< root mean squares of difference and reference
};

/// Elements are matched by their centroids before loading, components of g by their order. `start`
/// gives the weights.
Differences compare(const CentroidValues& ours, const CentroidValues& reference,
                    const mesh::Snapshot& start);

}  // namespace polyslip::tests
