#pragma once
// What the mesher meshes: a topology with a shape for each of its entities. The first mesh takes
// straight edges and the faces' interpolation triangles; a remeshing takes the old mesh's quadratic
// lines and triangles. There is one meshing pipeline for both.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/timer.hpp"
#include "core/types.hpp"
#include "mesh/deformed_regularisation.hpp"
#include "mesh/mesh.hpp"
#include "mesh/tessellation.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh {

/// Chain of quadratic segments from the edge's vertex 0 to vertex 1: points[2 i] are ends,
/// points[2 i + 1] mid nodes (a straight edge: 3 points).
struct EdgeShape {
  std::vector<core::Vec3> points;
};

/// Six-node triangles that interpolate a face (flat ones: mid nodes at mid points); oriented as the
/// face. Their boundary is the chain of the face's edge shapes.
struct FaceShape {
  std::vector<core::Vec3> points;
  std::vector<std::array<int, 6>> triangles;
};

struct Geometry {
  Topology topology;
  Domain domain = box_domain({1, 1, 1});
  core::Vec3 size{1, 1, 1};  ///< of the domain's bounding box
  std::vector<core::Vec3> vertices;
  std::vector<EdgeShape> edges;
  std::vector<FaceShape> faces;
  std::vector<double> volumes;  ///< wanted of grains in a remeshing; none: those of the shapes
  bool from_mesh = false;  ///< shapes are those of a mesh, so that a face's old mesh may be kept
};

Geometry geometry_of(const Tessellation& tessellation);
/// From a (deformed) mesh of order 2.
Geometry geometry_of(const Mesh& mesh);

/// The frame in which a deformed polycrystal has its size at zero strain again, and its grains
/// their shapes, but for what distinguishes them: size / extent along each axis. (1, 1, 1) unless
/// it is from a mesh. Projections and what depends on angles are taken there.
core::Vec3 isotropic_scale(const Geometry& geometry);
core::Vec3 isotropic_scale(const Mesh& mesh);

/// What a deck asks for in [mesh].
struct MeshingOptions {
  double element_size = 0.5;                 ///< c_l, for grains of unit mean volume
  std::optional<double> outer_element_size;  ///< c_l of grains with a face on the domain boundary
  std::vector<double> grain_element_sizes;   ///< [grains] c_l of each, above the others; or none
  double progression_factor = 2.0;           ///< p_l
  int order = 2;
  std::vector<std::string> meshers{"gmsh-hxt", "gmsh-delaunay", "netgen"};
  std::vector<std::string> face_meshers{own_face_mesher};  ///< the first that is good enough
  double mesher_target = 0.9;  ///< share of the surface's O from which on no further mesher tries
  double mesher_timeout = 60;  ///< seconds of CPU a grain and candidate
  int jobs = 0;                ///< worker processes, and threads; 0: one a core
  bool slide_boundary = true;  ///< nodes slide in faces and along edges after the grains are meshed
};

struct MeshingReport {
  std::vector<int> copied_faces;        ///< faces whose old mesh was kept (section 2.3.3)
  std::vector<std::string> why_copied;  ///< [copied_faces] in words
  std::vector<std::string> faults;      ///< one line for each candidate that crashed or was invalid
  std::vector<int> wins;                ///< [meshers] grains won by each
  std::vector<int> face_wins;           ///< [face meshers] faces won by each, copied ones left out
  int straightened = 0;                 ///< mid nodes pulled towards their chord to keep det J > 0
  int nearest_points = 0;               ///< nodes beyond their old face, put on its nearest point
  double mean_O = 0;                    ///< mean over grains of eq. (5)
  double progression = 1;         ///< largest ratio of adjacent 1D lengths (copied edges left out)
  DeformedRegularisation opened;  ///< of the new mesh of a deformed polycrystal
  int conformal_faces = 0, circle_faces = 0;  ///< laid flat by these maps, not by projection
  core::StageTimes times;  ///< of this process: "faces", "meshing" (without the meshers),
                           ///< "sliding", "assembly"
};

/// How far a stage ("meshing faces", "meshing grains", "sliding nodes", "meshing poor grains",
/// "assembling") is, 0 ... 1.
using MeshingProgress = std::function<void(const std::string& stage, double fraction)>;

/// What had to be given up of the surfaces, in one line: mid nodes pulled in, nodes put on a
/// nearest point, faces copied. Empty if nothing.
std::string repairs_text(const MeshingReport& report);

/// Meshes a geometry, bottom up (sections 2.2 and 2.3). Sizes are taken in the frame scaled by
/// `scale` (x_scaled = scale * x, component by component): (1, 1, 1) for none. Same input, same
/// mesh, for any number of workers. Throws RecoverableError if a face or a grain cannot be meshed,
/// naming it; InternalError if the first mesh does not fill the domain to 1e-12.
Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const core::Vec3& scale,
                   MesherPool& pool, MeshingReport& report, const MeshingProgress& progress = {});

}  // namespace polyslip::mesh
