#pragma once
// Meshes in Gmsh's formats.

#include <span>
#include <string>

#include "core/types.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

struct MshFormat {
  bool newest = false;  ///< format 4.1, else 2.2
  bool binary = false;  ///< in this machine's byte order
};

/// Tetrahedra, with grains as physical and elementary volumes, and triangles of the domain's
/// surface, with its named surfaces as physical ones and faces as elementary ones; numbers are ours
/// and one. `orientations`, one a grain or none, as $ElsetOrientations. ASCII numbers are the
/// shortest that read back to the same double. Written beside and renamed; InputError if that
/// fails.
void write_msh(const Mesh& mesh, const std::string& path, const MshFormat& format,
               std::span<const core::Quaternion> orientations = {});

}  // namespace polyslip::mesh
