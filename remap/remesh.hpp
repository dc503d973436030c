#pragma once
// Remeshing of a deformed polycrystal (section 2.3): new mesh, state carried over, audit.

#include <functional>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/snapshot.hpp"
#include "mesh/volume_mesher.hpp"
#include "remap/wear.hpp"

namespace polyslip::remap {

/// What a deck asks for in [remeshing].
struct RemeshingOptions {
  bool automatic = true;           ///< besides at_strains: worn elements, steps that fail
  std::vector<double> at_strains;  ///< increasing
  WearOptions wear;
  double min_interval = 0.05;  ///< strain; no worn elements are looked for on a younger mesh
  /// Share of the shortening that element sizes follow: 1 keeps the number of elements across a
  /// direction in which the polycrystal was compressed (the paper, section 3.1), 0 keeps their
  /// size.
  double orthotropic_share = 1;
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

/// The frame in which sizes and projections are taken: (size / extent)^share along each axis along
/// which the polycrystal's extent has become less than its size at zero strain, 1 along the others.
core::Vec3 meshing_scale(const mesh::Mesh& mesh, double orthotropic_share);

/// State and nodal fields of `old` on `mesh` (0-order by centroid within the same grain; nodal
/// fields by shape functions; see core::Transport).
mesh::Snapshot transport(const mesh::Snapshot& old, mesh::Mesh mesh);

}  // namespace polyslip::remap
