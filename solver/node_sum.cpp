#include "solver/node_sum.hpp"

namespace polyslip::solver {

NodeSum::NodeSum(const LocalMesh& local)
    : start_(static_cast<std::size_t>(local.local_nodes) + 1, 0),
      entry_(10 * local.elements.size()) {
  for (const auto& e : local.elements)
    for (int node : e) ++start_[static_cast<std::size_t>(node) + 1];
  for (std::size_t n = 1; n < start_.size(); ++n) start_[n] += start_[n - 1];
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  std::size_t at = 0;
  for (const auto& e : local.elements)
    for (int node : e) entry_[next[node]++] = at++;
}

template <class T>
void NodeSum::operator()(const std::vector<T>& values, T* out) const {
  const auto nodes = static_cast<int>(start_.size()) - 1;
#pragma omp parallel for schedule(static)
  for (int n = 0; n < nodes; ++n) {
    T sum[3] = {};
    for (std::size_t k = start_[n]; k < start_[n + 1]; ++k)
      for (std::size_t i = 0; i < 3; ++i) sum[i] += values[3 * entry_[k] + i];
    for (std::size_t i = 0; i < 3; ++i) out[3 * static_cast<std::size_t>(n) + i] = sum[i];
  }
}

template void NodeSum::operator()(const std::vector<float>&, float*) const;
template void NodeSum::operator()(const std::vector<double>&, double*) const;

}  // namespace polyslip::solver
