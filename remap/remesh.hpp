#pragma once
// Remeshing of a deformed polycrystal (section 2.3): new mesh, state carried over, audit.

#include <functional>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/snapshot.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::remap {

/// What a deck asks for in [remeshing].
struct RemeshingOptions {
  std::vector<double> at_strains{0.3};
  double max_grain_volume_change =
      0.005;  ///< relative; beyond it the run stops and names the grain
};

struct RemeshReport {
  double strain = 0;
  int elements_before = 0, elements_after = 0;
  double min_radius_ratio_before = 0, min_radius_ratio_after = 0;
  double max_grain_volume_change = 0;  ///< relative
  double rms_grain_volume_change = 0;
  double max_mean_rotation = 0, mean_mean_rotation = 0;  ///< of grains' mean orientations, degrees
  mesh::MeshingReport meshing;
};

/// The deformed snapshot with a new mesh of the same topology. Throws RecoverableError if no valid
/// mesh comes out or the audit fails; the old snapshot is untouched.
mesh::Snapshot remesh(const mesh::Snapshot& old, const mesh::MeshingOptions& meshing,
                      const RemeshingOptions& options, mesh::MesherPool& pool, RemeshReport& report,
                      const std::function<void(const std::string&)>& log);

/// State and nodal fields of `old` on `mesh` (0-order by centroid within the same grain; nodal
/// fields by shape functions; see core::Transport).
mesh::Snapshot transport(const mesh::Snapshot& old, mesh::Mesh mesh);

}  // namespace polyslip::remap
