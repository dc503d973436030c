#pragma once
// From a deck to an undeformed, meshed polycrystal: what `polyslip mesh` and `polyslip run` share.

#include <string>
#include <vector>

#include "core/log.hpp"
#include "core/timer.hpp"
#include "drivers/options.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::drivers {

/// Grows, regularises and meshes the polycrystal of a deck; writes polycrystal.tess and
/// mesh-000.msh into `folder`. On one rank. Throws RecoverableError if a grain cannot be meshed.
mesh::Mesh generate_polycrystal(const Options& options, const std::string& folder,
                                mesh::MesherPool& pool, core::Log& log, core::StageTimes& times);

}  // namespace polyslip::drivers
