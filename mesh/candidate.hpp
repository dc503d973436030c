#pragma once
// When a grain's mesh is good enough for no further mesher to be tried.

#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// What a grain's surface triangles allow: the worst element cannot be much better than the worst
/// triangle, nor sizes than theirs (docs/theory-polycrystal.md, section 5).
struct SurfaceBounds {
  double floor = 0;  ///< radius ratio that the worst element must reach
  double O = 0;      ///< O that a mesh of regular elements of the triangles' sizes would have
};
SurfaceBounds surface_bounds(const SurfaceMesh& surface, double element_size);

/// Whether a mesh whose worst radius ratio is `worst` reaches the floor, and its O `target` times
/// the bound's. Nothing reaches a target of 1.
bool is_good(const SurfaceBounds& bounds, double worst, double O, double target);

}  // namespace polyslip::mesh
