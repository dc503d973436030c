#pragma once
// Gmsh's section $Periodic: which nodes of a surface are translates of which of another.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// A pair of faces of a periodic mesh.
struct PeriodicLink {
  int slave = 0, master = 0;                    ///< faces
  core::Vec3 translation = core::Vec3::Zero();  ///< of the slave from the master
  std::vector<std::pair<int, int>> nodes;       ///< node of the slave, of the master
};

/// One for each pair of topology.periodic.faces, with all nodes of the two faces.
std::vector<PeriodicLink> periodic_links(const Mesh& mesh);

/// Directions in which a mesh of nodes that are translates repeats, and by how much.
struct PeriodicBox {
  std::array<bool, 3> directions{false, false, false};
  core::Vec3 periods = core::Vec3::Zero();
};

/// Pairs of nodes from links, of which only translation and nodes are looked at, in a file's units:
/// of the translates of a node the one of the least number is the master, wherever links lead. Says
/// what is wrong with them in `fault`, if something is: nodes that are not where they should be
/// within `distance`, contradictions.
std::vector<PeriodicPair> join_links(const std::vector<PeriodicLink>& links,
                                     const std::vector<core::Vec3>& nodes, double distance,
                                     PeriodicBox& box, std::string& fault);

}  // namespace polyslip::mesh
