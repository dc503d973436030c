#pragma once
// How far the elements of a deforming mesh have worn, and whether it is time for a new mesh
// (section 2.3 of the paper leaves that to the user).

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/snapshot.hpp"

namespace polyslip::remap {

/// Measures of a mesh, each blind to its homogeneous deformation, which flattens every element
/// alike and which a new mesh would not undo.
struct Wear {
  /// Least 3 r_in / R_circ of the corners' tetrahedra, in the frame scaled back to isotropy.
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

/// The linear part A of the least-squares fit `initial = A current + b` over all nodes: the inverse
/// of the mean deformation gradient. The frame x_scaled = A x is the one scaled back to isotropy,
/// in which a homogeneous motion does nothing. Throws InternalError for nodes in a plane.
core::Mat3 isotropy_frame(std::span<const core::Vec3> initial, std::span<const core::Vec3> current);

/// Positions at zero strain of a snapshot's nodes: current ones less the displacement.
std::vector<core::Vec3> initial_positions(const mesh::Snapshot& snapshot);

/// Of ten-node elements with nodes at `positions`; `rates`: change of the positions per unit
/// strain, but for a homogeneous motion (which changes no ratio of det J), or empty if it is not
/// known.
Wear measure_wear(std::span<const std::array<int, 10>> tetrahedra,
                  std::span<const core::Vec3> positions, std::span<const core::Vec3> rates,
                  const core::Mat3& frame, const WearOptions& options, int threads);

/// Why a mesh needs replacing, in words with numbers, given what it was when it left the mesher;
/// nothing if it does not.
std::optional<std::string> worn(const Wear& fresh, const Wear& now, const WearOptions& options);

}  // namespace polyslip::remap
