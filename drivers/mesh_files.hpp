#pragma once
// The mesh files of a run folder.

#include <string>
#include <vector>

#include "mesh/mesh_formats.hpp"

namespace polyslip::drivers {

/// Writes the mesh of a number in each of the formats (mesh::mesh_format_names()) into the folder.
/// InputError if that fails.
void write_mesh_files(const mesh::Mesh& mesh, const std::string& folder, int number,
                      const std::vector<std::string>& formats, const mesh::GrainNotes& notes = {});

}  // namespace polyslip::drivers
