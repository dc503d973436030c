#pragma once
// Facets of tetrahedra between two grains, on the domain, or across a periodic boundary.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/translated_nodes.hpp"

namespace polyslip::mesh {

/// A facet of a face: nodes out of `cell`, into `other` (-1 - b: face b of the domain; below those,
/// a neighbour across a periodic boundary).
struct Panel {
  std::array<int, 6> nodes;
  int cell, other;
  int twins = -1;        ///< which pair of translates it is of
  Shift shift{0, 0, 0};  ///< of its translate from it
};

struct SurfacePanels {
  std::vector<Panel> panels;  ///< sorted by `cell` and `other`
  int twins = 0;              ///< pairs of translates
};

/// Puts nodes that lie on the domain on it. InputError, naming grains by `names`, for facets of
/// more than two elements and free ones that lie on no face of the domain.
SurfacePanels find_panels(Mesh& mesh, const std::vector<int>& names,
                          const TranslatedNodes& translated);

}  // namespace polyslip::mesh
