#pragma once
// Meshes of a geometry's edges and faces (1D and 2D meshing), kept up to date while faces are
// switched to their old mesh.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/face_mesher.hpp"
#include "mesh/geometry.hpp"
#include "mesh/planar_mesher.hpp"
#include "mesh/projection.hpp"
#include "mesh/size_field.hpp"

namespace polyslip::mesh {

struct EdgeMesh {
  std::vector<core::Vec3> nodes;  ///< from vertex 0 to vertex 1, both included
  std::vector<core::Vec3> mids;   ///< one an element
  std::vector<double> arcs;       ///< arc lengths of the nodes (CurvedEdge); none if copied
};

/// How a face is laid flat.
enum class Flattening { mean_plane, conformal, isotropic_plane, circle };

/// Local node numbers: those on the boundary in the order of the face's loop, then inner ones.
struct FaceMesh {
  struct InnerEdge {
    int a = 0, b = 0;  ///< a < b
    core::Vec3 mid = core::Vec3::Zero();
  };
  int boundary_count = 0;
  std::vector<core::Vec3> inner_nodes;
  std::vector<std::array<int, 3>> triangles;  ///< normals as the face's
  std::vector<InnerEdge> inner_edges;         ///< sorted by (a, b)
  int nearest_points = 0;  ///< nodes beyond the old face, put on its nearest point
  Flattening flattening = Flattening::mean_plane;
  std::vector<Eigen::Vector2d> places;  ///< of all nodes in the plane; none if copied
};

/// Ids of the corner nodes: vertices, then inner nodes of edges by edge, then of faces by face.
struct BoundaryNumbers {
  std::vector<int> edge_first, face_first;
  int count = 0;
};

class BoundaryMesher {
 public:
  /// The geometry must outlive the mesher. Without `face_meshers`, ours meshes all faces.
  BoundaryMesher(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                 FaceMeshers face_meshers = {});

  /// Keep a face's old mesh, and with it those of its edges, from the next update on. False if it
  /// is kept already or the geometry has none.
  bool copy(int face, const std::string& why);
  /// Why a face's old mesh is kept; empty if it is not.
  const std::string& why_copied(int face) const { return why_copied_[face]; }
  bool is_copied(int face) const { return face_copied_[face]; }
  /// Whether it lies in a domain face that is a plane.
  bool is_flat(int face) const {
    const int domain = geometry_.topology.faces[face].domain_face;
    return domain >= 0 && planes_[domain];
  }
  /// Meshes what is new or has to change and returns the faces whose mesh changed, sorted. A face
  /// that cannot be meshed is copied; RecoverableError, naming it and why, if it cannot be.
  std::vector<int> update();

  /// c_l of a grain.
  double grain_size(int grain) const { return sizes_.grains[grain]; }
  const Geometry& geometry() const { return geometry_; }
  /// Itself if it is no slave.
  int master_of_vertex(int vertex) const { return vertex_masters_[vertex]; }
  const core::Vec3& scale() const { return scale_; }
  /// The point of an edge at an arc length, exactly in the planes that the edge lies in.
  core::Vec3 edge_point(int edge, const CurvedEdge& curve, double arc) const;
  /// The way in which a face that is not copied is laid flat.
  FaceProjection projection(int face) const { return projection(face, faces_[face].flattening); }
  /// The point of a face above `place`, exactly in its plane if it has one; none beyond the face.
  std::optional<core::Vec3> face_point(int face, const FaceProjection& projection,
                                       const Eigen::Vector2d& place) const;
  /// Moves the nodes of an edge that is not copied to these arc lengths.
  void place_edge(int edge, std::vector<double> arcs);
  /// Gives slaves their masters' meshes, after those have moved.
  void renew_slaves();
  /// Moves the inner nodes of a face that is not copied, to these places in its plane; `positions`
  /// of all nodes, by number.
  void place_face(int face, const std::vector<Eigen::Vector2d>& inner_places,
                  const std::vector<core::Vec3>& positions, const BoundaryNumbers& numbers);

  const std::vector<core::Vec3>& vertices() const { return vertices_; }
  const std::vector<EdgeMesh>& edges() const { return edges_; }
  const std::vector<FaceMesh>& faces() const { return faces_; }
  BoundaryNumbers numbers() const;
  /// Positions by number.
  std::vector<core::Vec3> positions(const BoundaryNumbers& numbers) const;
  /// Numbers of a face's local nodes.
  std::vector<int> face_nodes(int face, const BoundaryNumbers& numbers) const;
  /// Largest ratio of the lengths of adjacent 1D elements, along edges and across vertices, copied
  /// edges left out.
  double largest_progression() const;
  /// [options.face_meshers] Faces whose mesh is of each; slaves and copied ones left out.
  std::vector<int> face_wins() const;
  /// One line for each mesh of a face that crashed or was invalid while another was found.
  const std::vector<std::string>& face_faults() const { return face_faults_; }
  /// Largest angle of a face's surface to its mean plane, radians.
  double distortion(int face) const;

 private:
  std::optional<Plane> common_plane(int domain_face) const;
  void find_planes();
  /// Puts a point on those of the domain faces that are planes.
  void keep_in_planes(core::Vec3& x, std::span<const int> domain_faces) const;
  void keep_in_plane_of(int face, core::Vec3& x) const;
  /// Lets sizes, lengths and vertices of translates be the same.
  void join_translates();
  bool is_slave_edge(int edge) const { return edge_masters_[edge] != edge; }
  bool is_slave_face(int face) const { return face_masters_[face] != face; }
  void copy_slave_edges();
  void copy_slave_edge(const PeriodicPair& pair);
  void copy_slave_faces(std::vector<char>& changed);
  void copy_slave_face(const PeriodicPair& pair);
  /// Forbids an inner edge of a face; of a slave, that of its master. Whether it was allowed.
  bool forbid(int face, std::array<int, 2> local);
  void mesh_edge(int edge);
  void finish_edge(int edge);
  void take_flat_sizes(PlanarProblem& problem, const std::vector<int>& nodes,
                       const std::vector<core::Vec3>& positions) const;
  /// Mid nodes of the inner edges; how far the farthest lies beyond the old face.
  double place_mids(int face, const FaceProjection& projection, const std::vector<core::Vec3>& x);
  void copy_edge(int edge);
  std::vector<double> node_sizes(const BoundaryNumbers& numbers) const;
  FaceProjection projection(int face, Flattening flattening) const;
  /// What faces are meshed from.
  struct Nodes {
    BoundaryNumbers numbers;
    std::vector<core::Vec3> positions;  ///< by number
    std::vector<double> sizes;          ///< by number, scaled frame
  };
  /// A way of laying a face flat, of which each part keeps this share of its area.
  struct Way {
    Flattening flattening;
    double share;
  };
  struct FaceWork;
  Nodes nodes() const;
  /// Meshes the faces of the list, or copies them; for each why it could not be done, or nothing.
  std::vector<std::string> mesh_list(const std::vector<int>& faces, const Nodes& nodes);
  void mesh_chunk(std::span<const int> faces, const Nodes& nodes, std::span<std::string> faults);
  void mesh_flattened(const Way& way, const Nodes& nodes, const std::vector<FaceWork*>& works);
  void begin_face(const Way& way, const Nodes& nodes, FaceWork& work);
  void try_mesher(std::size_t mesher, const std::vector<FaceWork*>& works);
  /// Carries the best plane mesh to the face.
  void finish_face(const Nodes& nodes, FaceWork& work);
  std::string name(int face) const;
  /// Number of a node of an edge, ends included.
  int number_of(int edge, int node, const BoundaryNumbers& numbers) const;
  void copy_face_mesh(int face);
  void mesh_faces(std::vector<char>& changed);
  /// Puts nodes under the apices of triangles that are flat over a 1D element (P.30); whether there
  /// were any. Their edges are stale then.
  bool cut_under_flat_triangles(const std::vector<char>& faces);
  struct EdgePlace {
    int edge = -1;
    double arc = 0;
  };
  EdgePlace under_flat_triangle(int face, const std::vector<core::Vec3>& x,
                                const BoundaryNumbers& numbers) const;
  EdgeGrading grading(int edge) const;
  void cut_edge(int edge, double arc);
  void mesh_edges();
  /// Nodes by the sizes at the edge's ends, `least_count` elements or more.
  std::vector<double> graded_arcs(int edge, int least_count) const;
  std::array<double, 2> end_elements(int edge) const;
  /// Least length of the elements at each vertex, those of copied edges left out.
  std::vector<double> least_at_vertices() const;
  /// More elements for edges whose elements are longer than p_l times another's at their vertex,
  /// until there are none.
  void balance_vertices();
  bool refine_at_vertices();
  struct EdgeEnd {
    int edge = -1, end = 0;
  };
  /// Elements alike on both sides of acute corners of faces; whether some were not (first meshes).
  bool balance_corners();
  bool make_alike(EdgeEnd a, EdgeEnd b);
  core::Vec3 end_chord(EdgeEnd end) const;
  /// 1D elements along a face's loop: edge and element of it; element k begins at local node k.
  std::vector<std::array<int, 2>> loop_elements(int face) const;
  /// Inner edges that join the same two nodes as another inner edge or a 1D element are forbidden;
  /// whether there were any.
  bool forbid_shared_edges();
  /// Inner edges with both ends in a plane of the domain that their face does not lie in are
  /// forbidden: the surface would lie on the domain's there. Whether there were any.
  bool forbid_edges_in_planes();
  /// The domain faces that a node of an edge or a vertex lies in, by its number.
  std::vector<std::span<const int>> domain_faces_of_nodes(const BoundaryNumbers& numbers) const;

  const Geometry& geometry_;
  MeshingOptions options_;
  core::Vec3 scale_;                          ///< frame of sizes
  core::Vec3 isotropy_;                       ///< frame of projections
  std::vector<std::optional<Plane>> planes_;  ///< [domain faces] of those that are flat
  DomainFaceLists vertex_planes_, edge_planes_;
  std::vector<core::Vec3> vertices_;
  ElementSizes sizes_;
  std::vector<int> vertex_masters_, edge_masters_, face_masters_;  ///< itself if it has none
  std::vector<double> edge_lengths_;
  std::vector<std::array<double, 2>> end_sizes_;  ///< [edges] sizes that its grading starts from
  std::vector<EdgeMesh> edges_;
  std::vector<FaceMesh> faces_;
  std::vector<std::vector<double>> cut_arcs_;  ///< [edges] nodes if some were put in; else empty
  std::vector<char> edge_copied_, face_copied_, edge_stale_, face_stale_;
  std::vector<std::string> why_copied_;
  std::vector<std::vector<std::array<int, 2>>> forbidden_;  ///< [faces] local numbers
  FaceMeshers face_meshers_;
  std::vector<int> face_mesher_;  ///< [faces] place in options.face_meshers; -1: copied or a slave
  std::vector<std::string> face_faults_;
};

}  // namespace polyslip::mesh
