#pragma once
// Topology of a polycrystal: vertices, edges, faces and cells (grains), shared between the
// tessellation, its geometry and every mesh made of it. A remeshing keeps it.

#include <array>
#include <string>
#include <vector>

#include "mesh/periodicity.hpp"

namespace polyslip::mesh {

/// The faces of the box, in the order of their ids: x0 x1 y0 y1 z0 z1 (0 ... 5).
inline const std::array<std::string, 6> box_face_names{"x0", "x1", "y0", "y1", "z0", "z1"};

struct TopologyEdge {
  std::array<int, 2> vertices{-1, -1};  ///< from, to
};

struct TopologyFace {
  std::vector<int> edges;     ///< in the order of the loop
  std::vector<bool> forward;  ///< whether the loop runs along edges[i] from its vertex 0 to 1
  std::array<int, 2> cells{-1,
                           -1};  ///< the normal (right-hand rule on the loop) points out of
                                 ///< cells[0] into cells[1]; cells[1] = -1 on the domain boundary
  int domain_face = -1;          ///< index of Domain::faces on the domain boundary, else -1
};

/// Ids are 0-based indices; files add one.
struct Topology {
  int vertex_count = 0;
  std::vector<TopologyEdge> edges;
  std::vector<TopologyFace> faces;
  std::vector<std::vector<int>> cell_faces;  ///< for each cell, its faces
  Periodicity periodic;                      ///< pairs of translates; empty if not periodic

  int cell_count() const { return static_cast<int>(cell_faces.size()); }
  /// Vertices of a face in the order of its loop; vertex i is the start of edge i.
  std::vector<int> face_vertices(int face) const;
  /// Throws InternalError if an invariant fails: loops closed, ids in range, each edge of a cell in
  /// exactly two of its faces, each cell's surface connected and touching itself nowhere
  /// (mesh/cell_surface.hpp), cells[1] = -1 iff domain_face >= 0, below the number of the domain's
  /// faces, or the face is one of a periodic pair; pairs as Periodicity says.
  void check(int domain_faces = 6) const;
};

}  // namespace polyslip::mesh
