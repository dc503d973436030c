#pragma once
// Meshes in Gmsh's formats.

#include <string>

#include "mesh/mesh_formats.hpp"

namespace polyslip::mesh {

struct MshOptions {
  bool newest = false;  ///< format 4.1, else 2.2
  bool binary = false;  ///< in this machine's byte order
};

/// Tetrahedra, with grains as physical and elementary volumes, and triangles of the domain's
/// surface, with its named surfaces as physical ones and faces as elementary ones; of grains
/// are those of the notes, others ours and one. Orientations are $ElsetOrientations. ASCII numbers
/// are the shortest that read back to the same double. Written beside and renamed; InputError if
/// that fails.
void write_msh(const Mesh& mesh, const std::string& path, const MshOptions& options,
               const GrainNotes& notes = {});

}  // namespace polyslip::mesh
