#pragma once
// What stands in a .tess file, before it is placed in its domain.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/tess_reader.hpp"

namespace polyslip::mesh {

struct TessContent {
  /// A face of **domain.
  struct DomainFace {
    std::string name, type;  ///< "plane", "cylinder", "sphere"
    Plane plane;             ///< of type "plane", of either direction
    std::vector<int> faces;  ///< of the tessellation, from 0
  };

  /// A row of **periodicity: the secondary is the primary, moved by shift * distances; with -1 its
  /// edge or loop runs backwards.
  struct Translate {
    int secondary = 0, primary = 0;
    Shift shift{0, 0, 0};
    int orientation = 1;
  };
  struct Translates {
    std::array<bool, 3> directions{false, false, false};
    core::Vec3 distances{0, 0, 0};
    std::vector<Translate> vertices, edges, faces;
  };

  /// Without sizes, domain and domain faces, and with positions as they stand in the file; normals
  /// of faces on the surface point outwards.
  TessellationFile file;
  std::string domain_type;  ///< empty without **domain
  std::vector<DomainFace> domain_faces;
  std::optional<Translates> periodic;  ///< **periodicity, if in some direction
};

/// InputError "<path>:<line>: <what>".
TessContent parse_tess(const std::string& path);

}  // namespace polyslip::mesh
