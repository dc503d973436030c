#pragma once
// `polyslip mesh`: only the polycrystal and its mesh.

#include <string>

#include "mesh/volume_mesher.hpp"

namespace polyslip::drivers {

/// Leaves polycrystal.tess, mesh-000.msh, the decks, log.txt and summary.json in `folder`. Throws
/// InputError before any file is touched if the deck or the folder is wrong, RecoverableError if a
/// grain cannot be meshed.
void make_mesh(const std::string& deck, const std::string& folder, bool overwrite,
               mesh::MesherPool& pool);

}  // namespace polyslip::drivers
