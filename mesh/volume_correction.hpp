#pragma once
// Grain volumes kept through a remeshing.

#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// Volume of each grain inside the quadratic faces of a geometry.
std::vector<double> grain_volumes(const Geometry& geometry);

/// Brings the volumes of a mesh of order 2 near to `wanted`. Two quadratic surfaces with the same
/// corner nodes differ between them; to first order only the mid nodes inside faces count for the
/// volume (the integral of a corner's shape function over a triangle is zero). Those of face f move
/// along the surface's normal by d_f = l_g - l_h, the difference of one number a grain, which
/// solves
///   sum over faces f of g of  a_f (l_g - l_h) = V_g(wanted) - V_g,
/// a_f the area that moves: of all ways to mend the volumes the one with the least sum of a_f
/// d_f^2. Faces of `fixed` and nodes on edges stay. Returns the largest |d_f|.
double correct_volumes(Mesh& mesh, const std::vector<double>& wanted,
                       const std::vector<char>& fixed);

}  // namespace polyslip::mesh
