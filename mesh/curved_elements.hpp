#pragma once
// Curved tetrahedra whose map folds or nearly does, mended.

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// Least det J of an element over the points of the 4- and 15-point rules and the ten nodes, as a
/// part of that of the straight element. NaN if that one is not positive or a node is no number.
double least_jacobian_ratio(const Mesh& mesh, int element);

/// Mends elements whose ratio is below 0.1. First the mid nodes of their edges inside a grain
/// follow the curved ones around them, which leaves the surfaces as they are; then, where that is
/// not enough, mid nodes on surfaces are pulled towards their chord by a quarter, the one that
/// helps most first, again and again.
/// Throws RecoverableError, naming element and grain, if an element with a curved edge stays unfit
/// when its edges are straight. Returns the number of mid nodes of surfaces moved.
int mend_curved_elements(Mesh& mesh, int threads = 1);

}  // namespace polyslip::mesh
