#pragma once
// Meshes as input of Abaqus (.inp).

#include <string>

#include "mesh/mesh_formats.hpp"

namespace polyslip::mesh {

/// *NODE, then *ELEMENT of type C3D4 or C3D10 (whose last two mid nodes change places against
/// Gmsh's), a set GRAINn of each grain; for each named surface of the domain a node set of its name
/// in capitals and an element-based *SURFACE, SURFACE_ and the name; with orientations *ORIENTATION
/// ORIENTATION_GRAINn, whose axes are the crystal's first two in the sample frame. Numbers have the
/// 13 digits that Abaqus' 20 characters hold. No materials or sections. Written beside and renamed;
/// InputError if that fails.
void write_inp(const Mesh& mesh, const std::string& path, const GrainNotes& notes = {});

}  // namespace polyslip::mesh
