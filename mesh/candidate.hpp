#pragma once
// When a grain's mesh is good enough for no further mesher to be tried.

#include <utility>
#include <vector>

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

/// The larger is the better mesh: first by the worst radius ratio as far as it is below 0.2 (in
/// steps of 0.02), then by O. O alone would take larger elements for a sliver.
std::pair<int, double> rank_of(double worst, double O);
/// The same with 0.3 for two meshes of a grain whose nodes have slid.
std::pair<int, double> rank_of_slid(double worst, double O);

/// A mesh's worst radius ratio and O.
struct MeshQuality {
  double worst = 0, O = 0;
};
/// Whether a mesh is to take the place of the present one, whose nodes have slid already: if it has
/// a better O and no worse an element, or if it mends one below 0.1 (in steps as above).
bool replaces(const MeshQuality& candidate, const MeshQuality& present);

/// The same where only the worst element counts: if that is better by more than 0.003, and O no
/// less than nine tenths.
bool raises(const MeshQuality& candidate, const MeshQuality& present);

/// Grains for which other meshers might have a better worst element: it is below 0.98 of the bound
/// of the grain's surface (mesh/facet_bound.hpp, no more than 0.3). The worst first, then by
/// number; no more than one in a hundred of all grains (rounded up), so that this costs little.
std::vector<int> worst_grains(const std::vector<double>& worst, const std::vector<double>& bounds);

}  // namespace polyslip::mesh
