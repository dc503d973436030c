#pragma once
// Follows the wear of a model's mesh.

#include <array>
#include <vector>

#include "mesh/snapshot.hpp"
#include "remap/remesh.hpp"

namespace polyslip::drivers {

/// Lives on rank 0. Keeps of a mesh what measuring its wear takes: elements and initial positions.
class MeshWatch {
 public:
  /// `threads`: of measuring.
  MeshWatch(const remap::RemeshingOptions& options, int threads)
      : options_(options.wear), threads_(threads) {}

  void watch(const mesh::Snapshot& snapshot);
  /// Of the mesh that is watched, with its nodes at `positions`; `rates`: see measure_wear.
  remap::Wear measure(const std::vector<core::Vec3>& positions,
                      const std::vector<core::Vec3>& rates) const;

 private:
  remap::WearOptions options_;
  int threads_;
  std::vector<std::array<int, 10>> tetrahedra_;
  std::vector<core::Vec3> initial_;
};

}  // namespace polyslip::drivers
