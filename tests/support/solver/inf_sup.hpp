#pragma once
// How stable the mean stresses of the mixed element are on a mesh.

#include "mesh/mesh.hpp"

namespace polyslip::test {

/// The discrete inf-sup constant of ten-node tetrahedra with one pressure each,
///   beta = min over p of max over u of  sum_e p_e (div u, 1)_e / (|p|_0 |grad u|_0),
/// for displacements as in plane-strain compression of the mesh's box: no normal displacement on
/// x0, y0, y1, z0 and z1, x1 free. beta^2 is the smallest eigenvalue of M^-1/2 B A^-1 B^T M^-1/2
/// (A: the gradients' products, B: volumes' derivatives, M: volumes), found by Lanczos' method.
/// For meshes of order 2 at zero strain, straight elements.
double inf_sup_constant(const mesh::Mesh& mesh);

}  // namespace polyslip::test
