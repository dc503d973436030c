#pragma once
// `polyslip mesh`: only the polycrystal and its mesh.

#include <string>

#include "mesh/volume_mesher.hpp"

namespace polyslip::drivers {

/// Leaves polycrystal.tess, mesh-000.msh, the decks, log.txt and summary.json in `folder`. Throws
/// InputError before any file is touched if the deck or the folder is wrong, RecoverableError if a
/// grain cannot be meshed. `jobs`: mesher processes and threads; 0: one a core. `picture`: a PNG of
/// the mesh to write too, if it is not empty; with `cut` without the grains of an eighth.
void make_mesh(const std::string& deck, const std::string& folder, bool overwrite, int jobs,
               mesh::MesherPool& pool, const std::string& picture = {}, bool cut = false);

}  // namespace polyslip::drivers
