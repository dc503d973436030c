#pragma once
// A tessellation in which what periodic translates share is there once: the work space of the
// periodic Voronoi tessellation and of its regularisation. Without periodic directions it is the
// tessellation itself.

#include <array>
#include <vector>

#include "core/types.hpp"
#include "mesh/periodicity.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

struct FoldedTessellation {
  struct Edge {
    std::array<int, 2> vertices{-1, -1};
    /// If vertex 0 is at its position, vertex 1 is at its own + shift * periods.
    Shift shift{0, 0, 0};
  };
  struct Face {
    std::vector<int> edges;
    std::vector<bool> forward;
    std::array<int, 2> cells{-1, -1};
    /// The loop begins at its first vertex's position + start * periods, in the frame of cells[0]:
    /// that in which the cell is around its seed.
    Shift start{0, 0, 0};
    /// What is at x in the frame of cells[0] is at x + step * periods in that of cells[1].
    Shift step{0, 0, 0};
    int domain_face = -1;
    Plane plane;  ///< in the frame of cells[0]
    int master = -1;
  };

  Domain domain;
  std::vector<core::Vec3> seeds;
  std::vector<double> weights;  ///< as of Tessellation
  std::vector<core::Vec3> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  std::vector<std::vector<int>> cell_faces;  ///< a face with the cell on both sides is there once
};

/// The body of whole grains. Entities keep their numbers; their translates, the slaves, come after
/// all of them. The master is the one met first along the faces.
Tessellation unfold(FoldedTessellation folded);

/// The inverse: masters in the order of their numbers.
FoldedTessellation fold(const Tessellation& tessellation);

}  // namespace polyslip::mesh
