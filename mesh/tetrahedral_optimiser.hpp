#pragma once
// Our own optimiser of a grain's inside, after the meshers' (docs/theory-polycrystal.md, section
// 5).

#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// `mesh`, a valid mesh of the inside of `surface`, with better elements: surface nodes and
/// triangles are the same, bit for bit; nodes inside may have moved, gone or come. Each change
/// raises the least radius ratio of the elements that it touches, or keeps it and lowers the sum of
/// rho^-3 (P.27 to P.29), so the worst element never gets worse. Same input, same output. If
/// rounding makes a result that is not valid, `mesh` itself is returned.
VolumeMesh optimise_inside(const SurfaceMesh& surface, const VolumeMesh& mesh);

/// The same for elements of radius ratio below `limit` and their nodes only, with the sum of
/// rho^-9.
VolumeMesh raise_worst_inside(const SurfaceMesh& surface, const VolumeMesh& mesh, double limit,
                              int power);

}  // namespace polyslip::mesh
