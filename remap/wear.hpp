#pragma once
// How far the elements of a deforming mesh have worn, and whether it is time for a new mesh
// (section 2.3 of the paper leaves that to the user).

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/snapshot.hpp"
#include "remap/isotropy_frame.hpp"

namespace polyslip::remap {

/// Measures of a mesh, each blind to its homogeneous deformation since it was made, which flattens
/// every element alike, and to the flatness that it was given (size_frame).
struct Wear {
  /// Least 3 r_in / R_circ of the corners' tetrahedra, in the frame of sizes.
  double worst_radius_ratio = 1;
  /// Share of elements whose radius ratio there is below WearOptions::poor_radius_ratio.
  double poor_share = 0;
  /// Least det J at the corners and at the points of the four-point rule, over its mean at the
  /// latter.
  double worst_jacobian = 1;
  /// Strain until some det J vanishes if every node goes on as in the last step; infinite if that
  /// is beyond WearOptions::inversion_strain.
  double inversion_strain = 0;
};

/// What a deck asks for in [remeshing]; see `worn`.
struct WearOptions {
  double radius_ratio_share = 0.5;    ///< of the mesh as it left the mesher
  double jacobian_share = 0.25;       ///< likewise
  double poor_radius_ratio = 0.2;     ///< elements below it are poor
  double poor_share_increase = 0.02;  ///< since the mesh left the mesher
  double inversion_strain = 0.03;     ///< projected strain until the first element inverts
};

/// What the elements of one part of a mesh (a rank's, say) add to the wear of the whole.
struct PartWear {
  double worst_radius_ratio = 1, worst_jacobian = 1;  ///< see Wear
  double inversion_strain = std::numeric_limits<double>::infinity();
  std::int64_t elements = 0, poor = 0;
};

/// Of all parts together; what is not a number in one is none in the whole. Without elements
/// nothing is worn.
Wear whole_wear(std::span<const PartWear> parts);

/// Positions at zero strain of a snapshot's nodes: current ones less the displacement.
std::vector<core::Vec3> initial_positions(const mesh::Snapshot& snapshot);

/// Of ten-node elements with nodes at `positions`; `rates`: change of the positions per unit
/// strain, but for a homogeneous motion (which changes no ratio of det J), or empty if it is not
/// known.
PartWear measure_part(std::span<const std::array<int, 10>> tetrahedra,
                      std::span<const core::Vec3> positions, std::span<const core::Vec3> rates,
                      const core::Mat3& frame, const WearOptions& options, int threads);
/// The same of a mesh in one part.
Wear measure_wear(std::span<const std::array<int, 10>> tetrahedra,
                  std::span<const core::Vec3> positions, std::span<const core::Vec3> rates,
                  const core::Mat3& frame, const WearOptions& options, int threads);

/// Why a mesh needs replacing, in words with numbers, given what it was when it left the mesher;
/// nothing if it does not.
std::optional<std::string> worn(const Wear& fresh, const Wear& now, const WearOptions& options);

}  // namespace polyslip::remap
