#include "mesh/msh_periodic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// A translate: the node that stands for all of them, and how far away it is.
using Place = std::pair<int, Shift>;

Place place_of(const Mesh& mesh, int node) {
  const auto& pairs = mesh.periodic_nodes;
  const auto found =
      std::lower_bound(pairs.begin(), pairs.end(), node,
                       [](const PeriodicPair& pair, int n) { return pair.slave < n; });
  if (found == pairs.end() || found->slave != node) return {node, Shift{0, 0, 0}};
  return {found->master, found->shift};
}

std::vector<std::vector<int>> nodes_of_faces(const Mesh& mesh) {
  std::vector<std::vector<int>> nodes(mesh.topology.faces.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int n : mesh.triangles[t])
      if (n >= 0) nodes[mesh.triangle_face[t]].push_back(n);
  for (auto& list : nodes) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return nodes;
}

/// Periods: the least translation along each axis.
PeriodicBox box_of(const std::vector<PeriodicLink>& links, double distance) {
  PeriodicBox box;
  for (const auto& link : links)
    for (int k = 0; k < 3; ++k) {
      const double length = std::abs(link.translation[k]);
      if (length <= distance) continue;
      if (!box.directions[k] || length < box.periods[k]) box.periods[k] = length;
      box.directions[k] = true;
    }
  return box;
}

/// Nodes joined by links, with their shifts from the first of them.
class NodeJoiner {
 public:
  explicit NodeJoiner(std::size_t count) : next_(count) {}

  void add(int slave, int master, const Shift& shift) {
    next_[master].push_back({slave, shift});
    next_[slave].push_back({master, -shift});
  }

  /// A fault if one node has two shifts.
  std::string run(std::vector<PeriodicPair>& pairs) {
    std::vector<char> seen(next_.size(), false);
    std::vector<Shift> shift(next_.size());
    for (std::size_t first = 0; first < next_.size(); ++first) {
      if (seen[first] || next_[first].empty()) continue;
      seen[first] = true;
      shift[first] = {0, 0, 0};
      std::vector<int> stack{static_cast<int>(first)};
      while (!stack.empty()) {
        const int node = stack.back();
        stack.pop_back();
        for (const auto& [other, step] : next_[node]) {
          const Shift there = shift[node] + step;
          if (seen[other]) {
            if (shift[other] != there) return "translates of nodes contradict each other";
            continue;
          }
          seen[other] = true;
          shift[other] = there;
          pairs.push_back({other, static_cast<int>(first), there});
          stack.push_back(other);
        }
      }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const PeriodicPair& a, const PeriodicPair& b) { return a.slave < b.slave; });
    return {};
  }

 private:
  std::vector<std::vector<Place>> next_;
};

}  // namespace

std::vector<PeriodicLink> periodic_links(const Mesh& mesh) {
  std::vector<PeriodicLink> links;
  const auto& pairs = mesh.topology.periodic.faces;
  if (pairs.empty()) return links;
  const auto nodes = nodes_of_faces(mesh);
  for (const auto& pair : pairs) {
    PeriodicLink link{pair.slave, pair.master, translated(Vec3::Zero(), pair.shift, mesh.size), {}};
    std::map<Place, int> masters;
    for (const int n : nodes[pair.master]) {
      const auto [node, shift] = place_of(mesh, n);
      masters[{node, shift + pair.shift}] = n;
    }
    for (const int n : nodes[pair.slave]) link.nodes.push_back({n, masters.at(place_of(mesh, n))});
    links.push_back(std::move(link));
  }
  return links;
}

std::vector<PeriodicPair> join_links(const std::vector<PeriodicLink>& links,
                                     const std::vector<Vec3>& nodes, double distance,
                                     PeriodicBox& box, std::string& fault) {
  box = box_of(links, distance);
  NodeJoiner joiner(nodes.size());
  std::vector<PeriodicPair> pairs;
  for (const auto& link : links) {
    Shift shift{0, 0, 0};
    for (int k = 0; k < 3; ++k)
      if (box.directions[k])
        shift[k] = static_cast<int>(std::lround(link.translation[k] / box.periods[k]));
    for (const auto& [slave, master] : link.nodes) {
      const double off = (nodes[slave] - translated(nodes[master], shift, box.periods)).norm();
      if (!(off <= distance)) {
        fault = fmt::format("a node at ({:.6g}, {:.6g}, {:.6g}) is {:.3g} off its periodic place",
                            nodes[slave][0], nodes[slave][1], nodes[slave][2], off);
        return {};
      }
      if (slave != master) joiner.add(slave, master, shift);
    }
  }
  fault = joiner.run(pairs);
  return pairs;
}

}  // namespace polyslip::mesh
