#pragma once
// The surfaces of grains that are meshed, with nodes where they suit the elements on both sides
// (docs/theory-polycrystal.md, section 5).

#include <vector>

#include "mesh/boundary_mesh.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// Slides the inner nodes of edges along their edge and those of faces in their face, and moves the
/// insides along by optimise_inside. `volumes`: [grains], scaled frame, first nodes those of
/// grain_surface. Each step lowers the sum of rho^-3 over the elements that have the node, of every
/// grain, and lets none of them fall below the worst; adjacent 1D elements stay within
/// `progression_factor`, or do not get further from it. Vertices, and edges and faces whose old
/// mesh is kept, stay. Parts of the boundary that share a grain are never moved at once, so the
/// result is the same for any number of threads.
void slide_boundary(BoundaryMesher& boundary, std::vector<VolumeMesh>& volumes,
                    double progression_factor, int threads);

/// Elements of a lower radius ratio are raised by themselves.
inline constexpr double worst_limit = 0.3;

/// Six times: slides those nodes only that elements below worst_limit have, by the sum of
/// rho^-9 and, later, rho^-18 and rho^-27, and improves these elements (raise_worst_inside);
/// otherwise as slide_boundary.
void raise_worst(BoundaryMesher& boundary, std::vector<VolumeMesh>& volumes,
                 double progression_factor, int threads);

/// The same for one grain whose surface stays.
VolumeMesh raise_worst(const SurfaceMesh& surface, VolumeMesh mesh);

}  // namespace polyslip::mesh
