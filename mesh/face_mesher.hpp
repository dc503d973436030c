#pragma once
// Meshers of faces, of which the best mesh of each face is taken (section 2.2.2: multimeshing).

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "mesh/planar_mesher.hpp"

namespace polyslip::mesh {

/// Names that a deck may list: ours (mesh/planar_mesher.hpp), which runs in this process, and
/// Gmsh's frontal-Delaunay and Delaunay, which run in mesher processes.
inline constexpr const char* own_face_mesher = "own";
inline const std::array<std::string, 3> known_face_meshers{own_face_mesher, "gmsh-frontal",
                                                           "gmsh-delaunay"};

struct FaceRequest {
  int face = 0;  ///< for messages
  PlanarProblem problem;
};

/// Meshes of the requested faces by one mesher of the list above that is not ours; where there is
/// none, `fault` says why. Each is valid (below).
using FaceMeshers = std::function<std::vector<PlanarMesh>(const std::vector<FaceRequest>& requests,
                                                          const std::string& mesher)>;

/// Why `mesh` is not one of the problem: empty if it is (first points the boundary's, bit for bit,
/// its edges not split; areas positive and adding up; every point used; no forbidden edge).
std::string validate(const PlanarProblem& problem, const PlanarMesh& mesh);

/// Cuts forbidden inner edges in two, in the middle. False if the four triangles of one would not
/// all be positive.
bool split_forbidden_edges(const PlanarProblem& problem, PlanarMesh& mesh);

/// Least radius ratio 2 r_in/R_circ of the triangles; 0 without any.
double min_radius_ratio(const PlanarMesh& mesh);

/// O of eqs. (4)-(7) with the triangles' radius ratios and mean edge lengths.
double mesh_quality_O(const PlanarMesh& mesh, double element_size);

/// Radius ratio that the worst triangle must reach for no further mesher to be tried: the part 0.7
/// of what the sharpest corner of the boundary allows, 0.3 at most
/// (docs/theory-polycrystal.md, section 4).
double worst_triangle_floor(const PlanarProblem& problem);

/// The best of the meshes of one face. Whichever order they come in, the same one wins: first by
/// the worst radius ratio as far as it is below the floor (in tenths of it), then by O, then by the
/// mesher's place in the list.
class FaceCandidates {
 public:
  explicit FaceCandidates(const PlanarProblem& problem)
      : floor_(worst_triangle_floor(problem)), element_size_(problem.element_size) {}
  /// A mesh with a fault does not count.
  void offer(std::size_t mesher, PlanarMesh&& mesh);
  bool good_enough() const { return any_ && least_ >= floor_; }
  bool any() const { return any_; }
  std::size_t mesher() const { return mesher_; }
  PlanarMesh& best() { return mesh_; }

 private:
  double floor_, element_size_;
  bool any_ = false;
  std::size_t mesher_ = 0;
  int steps_ = 0;
  double least_ = 0, O_ = 0;
  PlanarMesh mesh_;
};

}  // namespace polyslip::mesh
