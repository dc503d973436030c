#pragma once
// What stands in a file of Gmsh's, before it is made a mesh of a polycrystal.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace polyslip::mesh {

/// Ids are the file's.
struct MshContent {
  struct Tetrahedron {
    std::array<int, 10> nodes;  ///< -1 for mid nodes of order 1
    int physical = 0, elementary = 0;
    int number = 0;
  };
  struct Triangle {
    std::array<int, 3> corners;
    int physical = 0;
  };

  /// A pair of entities in $Periodic.
  struct Link {
    std::optional<core::Vec3> translation;   ///< of its affine motion, where it has one
    std::vector<std::pair<int, int>> nodes;  ///< of the slave, of the master
  };

  int order = 1;
  std::vector<std::pair<int, int>> node_ids;  ///< id and place in `positions`, sorted
  std::vector<core::Vec3> positions;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Triangle> triangles;                   ///< those with a physical surface
  std::map<std::pair<int, int>, std::string> names;  ///< of dimension and physical id
  std::map<int, core::Quaternion> orientations;      ///< of grains ($ElsetOrientations)
  std::map<int, int> groups;                         ///< of grains ($Groups)
  std::vector<Link> links;                           ///< of any dimension
};

/// Parses formats 2.2 and 4.1, ASCII and binary of either byte order, `.gz` too. Sections that are
/// not known, and elements other than tetrahedra and triangles of dimension below three, are
/// skipped. InputError "<path>:<line>: <what>", "<path>: at byte <n>: <what>" in a binary file.
MshContent parse_msh(const std::string& path);

}  // namespace polyslip::mesh
