#pragma once
// Nodes of a periodic mesh, where translates are told from their masters.

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// A node's master, and by how many periods the node is away from it.
struct NodePlace {
  int master = -1;
  Shift shift{0, 0, 0};
  auto operator<=>(const NodePlace&) const = default;
};

class TranslatedNodes {
 public:
  explicit TranslatedNodes(const Mesh& mesh) : places_(mesh.nodes.size()) {
    for (std::size_t n = 0; n < places_.size(); ++n) places_[n].master = static_cast<int>(n);
    for (const auto& pair : mesh.periodic_nodes) places_[pair.slave] = {pair.master, pair.shift};
  }

  const NodePlace& place(int node) const { return places_[node]; }
  /// Whether `slave` is where `master` is, moved by the shift.
  bool is_translate(int slave, int master, const Shift& shift) const {
    return places_[slave].master == places_[master].master &&
           places_[slave].shift == places_[master].shift + shift;
  }
  /// The same for all translates of a set of nodes; second, where this one is.
  template <std::size_t N>
  std::pair<std::array<NodePlace, N>, Shift> standard(const std::array<int, N>& nodes) const {
    std::array<NodePlace, N> key;
    for (std::size_t i = 0; i < N; ++i) key[i] = places_[nodes[i]];
    std::sort(key.begin(), key.end());
    const Shift base = key[0].shift;
    for (auto& place : key) place.shift = place.shift - base;
    return {key, base};
  }
  /// The same for all translates of the mesh edge from a to b.
  std::tuple<int, int, Shift> directed(int a, int b) const {
    return {places_[a].master, places_[b].master, places_[b].shift - places_[a].shift};
  }

 private:
  std::vector<NodePlace> places_;
};

}  // namespace polyslip::mesh
