#pragma once
// The meshers that a mesher process holds. Their libraries keep global state, leave it broken after
// an error and may crash or hang: they are called in a child process only.

#include <memory>
#include <string>

#include "mesh/face_mesher.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh::worker {

/// Sizes asked of a mesher are this share of c_l, for a mean element edge near c_l (design: 4).
inline constexpr double size_share = 0.7;

class Mesher {
 public:
  virtual ~Mesher() = default;
  /// Tetrahedra inside `surface`, edges of about `element_size`. Not validated. May throw anything;
  /// the process must not mesh again then.
  virtual VolumeMesh fill(const SurfaceMesh& surface, double element_size) = 0;
  /// Whether our optimiser of a grain's inside follows.
  virtual bool is_optimised() const { return true; }
};

class FaceMesher {
 public:
  virtual ~FaceMesher() = default;
  /// Triangles inside the problem's boundary, whose nodes come first. Not validated; inner edges
  /// may join any nodes. May throw anything; the process must not mesh again then.
  virtual PlanarMesh mesh(const PlanarProblem& problem) = 0;
};

/// Before the server forks: libraries initialised, nothing meshed.
void initialise_gmsh();
void initialise_netgen();

enum class GmshAlgorithm { delaunay = 1, hxt = 10 };  // values of Mesh.Algorithm3D
std::unique_ptr<Mesher> make_gmsh_mesher(GmshAlgorithm algorithm);
/// Netgen, with its optimiser unless it is `none`, then Gmsh's optimiser. Sizes asked for are
/// `share` of c_l.
enum class NetgenOptimiser { none, own };
std::unique_ptr<Mesher> make_netgen_mesher(NetgenOptimiser optimiser, double share);

/// One of `known_meshers`; nullptr for another name.
std::unique_ptr<Mesher> make_mesher(const std::string& name);

enum class GmshFaceAlgorithm { delaunay = 5, frontal = 6 };  // values of Mesh.Algorithm
std::unique_ptr<FaceMesher> make_gmsh_face_mesher(GmshFaceAlgorithm algorithm);
/// One of `known_face_meshers` that is not ours; nullptr for another name.
std::unique_ptr<FaceMesher> make_face_mesher(const std::string& name);

/// `mesh` after Gmsh's optimiser; boundary nodes stay.
VolumeMesh optimise_with_gmsh(const SurfaceMesh& surface, const VolumeMesh& mesh);

/// Drops nodes after the first `kept` that no tetrahedron uses.
VolumeMesh without_unused_nodes(const VolumeMesh& mesh, std::size_t kept);

}  // namespace polyslip::mesh::worker
