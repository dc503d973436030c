#pragma once
// What a remeshing changed.

#include "mesh/snapshot.hpp"
#include "remap/remesh.hpp"

namespace polyslip::remap {

/// Fills the report's figures about quality, grain volumes and mean orientations. Throws
/// RecoverableError if a grain's volume changed by more than the options allow, naming the grain.
void audit(const mesh::Snapshot& before, const mesh::Snapshot& after,
           const RemeshingOptions& options, RemeshReport& report);

}  // namespace polyslip::remap
