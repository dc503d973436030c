#pragma once
// Regularisation of a deformed polycrystal: what closes is held open (docs/theory-polycrystal.md,
// section 6).

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

struct DeformedRegularisationOptions {
  double least_radius_ratio = 0.15;  ///< elements below it are mended
  double largest_move = 0.1;         ///< of a node, in the scaled frame
};

struct DeformedRegularisation {
  int elements_before = 0, elements_after = 0;  ///< below the least radius ratio
  int moved = 0;                                ///< nodes of grains' surfaces that left them
  double largest_move = 0;                      ///< of these, in the scaled frame
};

/// Moves corner nodes of a worn mesh, whose elements are taken straight and in the frame scaled by
/// `scale`, until none has a radius ratio below the least one or nothing helps: nodes inside
/// grains first, then also those of surfaces, off them if need be, by no more than the largest
/// move, in the planes of the domain that they lie in. Where a solid angle closes, or a face comes
/// near another one or the domain's, only thin or inverted elements are left between them; so they
/// hold each other off. Mid nodes keep their bulge. Meshes of order 2; nodes of periodic faces
/// stay.
DeformedRegularisation regularise_deformed(Mesh& mesh, const core::Vec3& scale,
                                           const DeformedRegularisationOptions& options = {});

/// The same from the mesh as it is, with a largest move twice and four times as large where less
/// leaves elements below the least radius ratio.
DeformedRegularisation open_thin_elements(Mesh& mesh, const core::Vec3& scale,
                                          DeformedRegularisationOptions options = {});

}  // namespace polyslip::mesh
