#pragma once
// Nodes of grain boundaries that slide in their faces and along their edges
// (docs/theory-polycrystal.md, section 5).

#include <vector>

#include "mesh/boundary_mesh.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

struct Sliding {
  double progression_factor = 2;  ///< within which adjacent 1D elements stay
  int threads = 1;
  std::vector<char> chosen{};  ///< [BoundaryNumbers::count] whether a node slides; none: all do
  int power = 3;               ///< of 1/rho in (P.29), a multiple of three
};

/// Slides nodes down (P.29) over the elements of all grains, which do not change otherwise;
/// `volumes` as of slide_boundary. [grains] Whether nodes of each may have moved.
std::vector<char> slide_nodes(BoundaryMesher& boundary, const std::vector<VolumeMesh>& volumes,
                              const Sliding& sliding);

}  // namespace polyslip::mesh
