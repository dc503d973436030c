#pragma once
// What stands in a .tess file, before it is placed in its domain.

#include <array>
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

  /// Without sizes, domain and domain faces, and with positions as they stand in the file; normals
  /// of faces on the surface point outwards.
  TessellationFile file;
  std::string domain_type;  ///< empty without **domain
  std::vector<DomainFace> domain_faces;
};

/// InputError "<path>:<line>: <what>".
TessContent parse_tess(const std::string& path);

}  // namespace polyslip::mesh
