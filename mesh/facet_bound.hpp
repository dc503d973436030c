#pragma once
// What a facet leaves to the tetrahedra on it (docs/theory-polycrystal.md, section 5).

#include "core/types.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// Largest radius ratio (P.23) of a tetrahedron with this facet, over all places of its fourth
/// corner, to 1e-6; 0 if the facet has no area.
double best_on_triangle(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c);

/// The largest of these over all triangles with a corner of this angle [rad]: that of equal sides.
/// No mesh with this corner, or with parts of it, has a better worst element. 1 from 60 degrees on.
double best_at_corner(double angle);

/// Least of best_on_triangle over a surface's triangles, or `limit` if that is less.
double surface_bound(const SurfaceMesh& surface, double limit);

}  // namespace polyslip::mesh
