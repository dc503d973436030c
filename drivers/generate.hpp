#pragma once
// From a deck to an undeformed, meshed polycrystal: what `polyslip mesh` and `polyslip run` share.

#include <optional>
#include <string>
#include <vector>

#include "core/log.hpp"
#include "core/timer.hpp"
#include "drivers/options.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/tess_reader.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::drivers {

/// What a deck's files hold.
struct Input {
  std::optional<mesh::TessellationFile> tessellation;
  std::optional<mesh::MeshFile> mesh;
  std::vector<core::Quaternion> orientations;  ///< one a grain, from wherever the deck says
  bool orientations_of_input = false;          ///< from the tessellation or mesh file
};

/// Reads the tessellation or the mesh, and the orientations. Writes nothing, so that what is wrong
/// with a file shows before a run folder is touched. InputError for such a fault, and for a mesh
/// whose order is not the deck's.
Input read_input(const Options& options);

/// InputError if a tessellation from a file fills no box: loads are for boxes.
void require_box(const Options& options, const Input& input);

/// Grows the polycrystal of a deck or takes the input's, regularises and meshes it, or takes the
/// input's mesh; writes polycrystal.tess (unless the mesh is given) and mesh-000.msh into `folder`.
/// On one rank. Throws RecoverableError if a grain cannot be meshed.
mesh::Mesh generate_polycrystal(const Options& options, Input& input, const std::string& folder,
                                mesh::MesherPool& pool, core::Log& log, core::StageTimes& times);

}  // namespace polyslip::drivers
