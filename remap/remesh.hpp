#pragma once
// Remeshing of a deformed polycrystal (section 2.3): new mesh, state carried over, audit.

#include <functional>
#include <string>
#include <vector>

#include "mesh/deformed_regularisation.hpp"
#include "mesh/geometry.hpp"
#include "mesh/snapshot.hpp"
#include "mesh/volume_mesher.hpp"
#include "remap/grain_statistics.hpp"
#include "remap/transport.hpp"
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
  /// Share of the lengthening that element sizes follow: 0 keeps their size along a direction in
  /// which the polycrystal was drawn out (the paper), 1 the number of elements.
  double lengthening_share = 0.5;
  TransportOptions transport{"corrected", "zero"};  ///< docs/remeshing-accuracy.md says why
  // Limits of a remeshing; beyond them the run stops and names the grain.
  double max_grain_volume_change = 0.005;  ///< relative
  double max_grain_rotation = 5;           ///< of a grain's mean orientation [degrees]
  double max_grain_spread_change = 2;      ///< of the mean angle from it [degrees]
  double max_grain_g_change = 0.05;        ///< of its mean g, relative
};

/// Over all grains.
struct BodyStatistics {
  double volume = 0;                   ///< L^3
  double volume_at_zero_pressure = 0;  ///< L^3
  double mean_spread = 0;              ///< over the grains [degrees]
  FieldStatistics g, slip;             ///< weighted by volume; MPa, 1
  double elastic_energy = 0;           ///< MPa L^3
};

struct RemeshReport {
  double strain = 0;
  int elements_before = 0, elements_after = 0;
  double min_radius_ratio_before = 0, min_radius_ratio_after = 0;  ///< frame of sizes
  double max_grain_volume_change = 0;                              ///< relative
  double rms_grain_volume_change = 0;
  double max_mean_rotation = 0, mean_mean_rotation = 0;  ///< of grains' mean orientations, degrees
  double max_spread_change = 0;                          ///< of a grain, degrees
  double max_g_change = 0;                               ///< of a grain's mean, relative
  BodyStatistics before, after;
  std::vector<GrainStatistics> grains_before, grains_after;
  std::string beyond_limits;  ///< what is, naming the grain; empty if nothing
  mesh::DeformedRegularisation regularisation;
  mesh::MeshingReport meshing;
};

/// The deformed snapshot with a new mesh of the same topology. Throws RecoverableError if no valid
/// mesh comes out; `report.beyond_limits` says what the audit found. The old snapshot is untouched.
mesh::Snapshot remesh(const mesh::Snapshot& old, const mesh::MeshingOptions& meshing,
                      const RemeshingOptions& options, mesh::MesherPool& pool, RemeshReport& report,
                      const std::function<void(const std::string&)>& log);

/// The frame in which sizes are taken: along each axis (size / extent)^share, of the polycrystal's
/// extent and its size at zero strain, with the one share where it has become shorter and the other
/// where it has become longer.
core::Vec3 meshing_scale(const mesh::Mesh& mesh, const RemeshingOptions& options);

/// The shapes of a worn mesh after the regularisation of what closes, in the frame of sizes; its
/// grains' volumes as they were.
mesh::Geometry regularised_geometry(const mesh::Mesh& old, const RemeshingOptions& options,
                                    mesh::DeformedRegularisation& regularisation);

}  // namespace polyslip::remap
