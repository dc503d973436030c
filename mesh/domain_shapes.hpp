#pragma once
// Cylinders and spheres as convex polyhedra with many facets.

#include "mesh/domain.hpp"

namespace polyslip::mesh {

/// Cylinder along an axis (0 ... 2), elliptic if the other two extents differ, as the prism whose
/// sides touch it all around; the fewest sides whose volume exceeds the cylinder's by at most
/// `error`. Faces: the two ends, as of a box, and the sides, named "side".
Domain cylinder_domain(const core::Vec3& extents, int axis, double error, double volume);

/// Ellipsoid of these extents as the polyhedron whose facets, all named "surface", touch it at
/// points spread evenly (on the unit sphere a triangular lattice on an icosahedron, each point then
/// moved a few times to the middle of its facet): hexagons but for 12 pentagons, without short
/// edges; the fewest of them whose volume exceeds the ellipsoid's by at most `error`. InputError if
/// 27,002 facets are too few.
Domain sphere_domain(const core::Vec3& extents, double error, double volume);

}  // namespace polyslip::mesh
