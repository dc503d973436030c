#pragma once
// Sums of element values at nodes, by any number of threads with the same bits.

#include <vector>

#include "solver/partition.hpp"

namespace polyslip::solver {

/// The elements of each local node, in ascending order: adding node by node gives the bits of
/// adding element by element.
class NodeSum {
 public:
  explicit NodeSum(const LocalMesh& local);
  /// out[node] = sum over its elements of values[element][a][3]; [local_nodes][3].
  template <class T>
  void operator()(const std::vector<T>& values, T* out) const;

 private:
  std::vector<std::size_t> start_;  // [local_nodes + 1]
  std::vector<std::size_t> entry_;  // 10 element + a
};

}  // namespace polyslip::solver
