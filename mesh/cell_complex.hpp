#pragma once
// A tessellation that can be changed edge by edge and rolled back: the work space of the
// regularisation.

#include <array>
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "core/types.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

/// Ids stay what they were in the folded tessellation (mesh/folded_tessellation.hpp: translates are
/// one entity, each cell has a frame of its own); what is deleted is marked dead.
class CellComplex {
 public:
  struct Vertex {
    core::Vec3 position = core::Vec3::Zero();
    std::vector<int> edges;
    std::vector<int> walls;  ///< domain faces to which it is bound, ascending
    bool alive = true;
  };
  struct Edge {
    std::array<int, 2> vertices{-1, -1};
    Shift shift{0, 0, 0};  ///< of vertex 1 where vertex 0 is at its position
    std::vector<int> faces;
    bool alive = true;
  };
  struct Side {
    int edge = -1;
    bool forward = true;
  };
  struct Face {
    std::vector<Side> loop;
    std::array<int, 2> cells{-1, -1};
    Shift start{0, 0, 0};  ///< of the loop's first vertex, in the frame of cells[0]
    Shift step{0, 0, 0};   ///< from the frame of cells[0] to that of cells[1]
    int domain_face = -1;
    int master = -1;
    double fault = 0;  ///< squared chord of the flatness fault
    bool alive = true;
  };
  struct Cell {
    std::vector<int> faces;
  };

  explicit CellComplex(const Tessellation& tessellation);

  const Vertex& vertex(int id) const { return vertices_[id]; }
  const Edge& edge(int id) const { return edges_[id]; }
  const Face& face(int id) const { return faces_[id]; }
  const Cell& cell(int id) const { return cells_[id]; }
  /// Of the Voronoi tessellation: a face's plane, a cell's seed.
  const Plane& plane(int face) const { return planes_[face]; }
  const core::Vec3& seed(int cell) const { return seeds_[cell]; }
  int vertex_count() const { return static_cast<int>(vertices_.size()); }
  int edge_count() const { return static_cast<int>(edges_.size()); }
  int face_count() const { return static_cast<int>(faces_.size()); }

  double length(int edge) const;
  /// The planes of the domain faces to which a vertex is bound.
  std::vector<Plane> planes_at(int vertex) const;
  /// Vertices, and their positions in the frame of cells[0], along the loop of a face.
  std::vector<int> loop_vertices(int face) const;
  std::vector<core::Vec3> loop_points(int face) const;
  /// Position of one of its vertices in the frame of a face's cells[0].
  core::Vec3 position_in(int face, int vertex) const;
  /// From there to the frame of cells[1].
  core::Vec3 step(int face) const {
    return translated(core::Vec3::Zero(), faces_[face].step, domain_.size);
  }
  /// Faces and cells that meet at a vertex, ascending; -1, the outside, is the first of the cells.
  std::vector<int> faces_at(int vertex) const;
  std::vector<int> cells_at(int vertex) const;

  /// Why an edge cannot become a vertex so that each cell stays a polyhedron with the topology of a
  /// ball, and the domain keeps its corners, edges and faces. It can (none) if
  ///  - domain: one of the two vertices is bound to all the domain faces to which the other is
  ///    bound, and those to which both are bound hold the edge;
  ///  - topology: faces and cells (the outside included) that hold both vertices hold the edge;
  ///    vertices that neighbour both do so across a triangular face of the edge; no cell keeps
  ///    fewer than four faces. In periodic directions an entity that meets translates of both
  ///    vertices counts as holding both, and none at them may meet a translate of itself.
  enum class Obstacle { none, domain, topology };
  Obstacle obstacle(int edge) const;
  bool can_collapse(int edge) const { return obstacle(edge) == Obstacle::none; }

  /// Replaces an edge and its vertices by one vertex, whose id it returns: the edge's vertex 0,
  /// at the mid point or on the domain faces to which one of the two was bound. A triangular face
  /// of the edge collapses: its two other edges merge. Precondition: can_collapse.
  int collapse(int edge);

  void move(int vertex, const core::Vec3& position);
  void set_fan(int face, int master, double fault);

  /// What changes after a mark can be undone.
  std::size_t mark() const { return journal_.size(); }
  void roll_back(std::size_t mark);
  void commit() { journal_.clear(); }

  /// Whether a vertex that changed after the mark has only two edges in one of its cells: then two
  /// faces of that cell share a polyline of two edges.
  bool polyline_since(std::size_t mark) const;

  /// Writes the state back, renumbered without gaps in the order of the ids.
  void store(Tessellation& tessellation) const;

 private:
  struct Saved {
    int id;
    std::variant<Vertex, Edge, Face, Cell> content;
  };

  Vertex& change_vertex(int id);
  Edge& change_edge(int id);
  Face& change_face(int id);
  Cell& change_cell(int id);

  int start(const Side& side) const { return edges_[side.edge].vertices[side.forward ? 0 : 1]; }
  int opposite(int edge, int vertex) const;
  std::vector<int> triangles_of(int edge) const;
  bool on_polyline(int vertex) const;
  bool domain_allows(int edge) const;
  bool meets_itself(int edge) const;
  /// Lets the position of a vertex be what its translate's is now.
  void move_origin(int vertex, Shift shift);
  bool keeps_four_faces(const std::vector<int>& lost) const;
  void merge_sides_of_triangle(int face, int edge, int kept);

  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<Face> faces_;
  std::vector<Cell> cells_;
  std::vector<Plane> planes_;
  std::vector<core::Vec3> seeds_;
  std::vector<Saved> journal_;
  Domain domain_;
  bool periodic_ = false;
};

}  // namespace polyslip::mesh
