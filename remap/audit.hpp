#pragma once
// What a remeshing changed, grain by grain.

#include <string>

#include "mesh/snapshot.hpp"
#include "remap/remesh.hpp"

namespace polyslip::remap {

/// Fills the report's figures about quality and grains. Returns what is beyond the options' limits,
/// naming the grain; empty if nothing is.
std::string audit(const mesh::Snapshot& before, const mesh::Snapshot& after,
                  const RemeshingOptions& options, RemeshReport& report, int threads = 1);

}  // namespace polyslip::remap
