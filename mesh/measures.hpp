#pragma once
// Sizes and shapes of the grains, faces, edges and elements of a polycrystal: what its statistics
// are made of. Lengths are those of the tessellation or mesh.

#include <array>
#include <vector>

#include "core/types.hpp"
#include "mesh/mesh.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

struct GrainMeasures {
  bool inner = false;  ///< no face on the domain boundary
  core::Vec3 centroid = core::Vec3::Zero();
  double volume = 0;
  double area = 0;  ///< of its surface
  int faces = 0, edges = 0, vertices = 0;
  int neighbours = 0;  ///< other grains that share a face with it

  /// Diameter of the sphere of the same volume.
  double diameter() const;
  /// Area of the sphere of the same volume over the grain's own (Wadell, 1935):
  /// pi^(1/3) (6 V)^(2/3) / A; 1 for a sphere, 0.806 for a cube.
  double sphericity() const;
};

struct FaceMeasures {
  /// Of a periodic face the cell beyond it is that at its translate.
  std::array<int, 2> cells{-1, -1};
  bool is_translate = false;  ///< a slave of a periodic pair: its master stands for both
  int domain_face = -1;       ///< as in TopologyFace
  bool inner = false;         ///< belongs to an inner grain
  int edges = 0;
  double area = 0;
  /// Largest angle [degrees] between the normals of two triangles of the face: its interpolation
  /// triangles (section 2.1.2.2 of the paper), or those of the mesh.
  double flatness_fault = 0;
  /// Least angle [degrees] between two edges that follow each other, taken as straight.
  double least_corner = 0;

  /// Diameter of the circle of the same area.
  double diameter() const;
};

struct EdgeMeasures {
  std::array<int, 2> vertices{-1, -1};
  bool is_translate = false;  ///< as of a face
  bool inner = false;         ///< belongs to an inner grain
  int faces = 0;              ///< that meet at it, or at its translates
  double length = 0;
};

struct Measures {
  std::vector<GrainMeasures> grains;  ///< [cell]
  std::vector<FaceMeasures> faces;    ///< [face]
  std::vector<EdgeMeasures> edges;    ///< [edge]
  int vertices = 0;                   ///< translates counted once
};

/// Of the straight edges, the interpolation triangles and the cells that they bound.
Measures measure(const Tessellation& tessellation);

/// Of the quadratic lines, triangles and tetrahedra; flatness faults and centroids of the straight
/// ones through the corners. Lengths and areas of curved ones by Gauss quadrature of degree 5.
Measures measure(const Mesh& mesh);

struct ElementMeasures {
  double radius_ratio = 0;  ///< of the straight tetrahedron
  double size = 0;          ///< mean of the lengths of its six edges, straight
};
ElementMeasures measure_element(const Mesh& mesh, int element);

struct GrainMeshMeasures {
  int elements = 0;
  double min_radius_ratio = 0, mean_radius_ratio = 0;
  double mean_size = 0;
  double O_dis = 0, O_size = 0, O = 0;  ///< eqs. (6), (7), (5) of the paper
};

/// One a grain; `element_sizes`: [grain] c_l of eq. (7).
std::vector<GrainMeshMeasures> measure_grain_meshes(const Mesh& mesh,
                                                    const std::vector<double>& element_sizes);
/// The same c_l for all.
std::vector<GrainMeshMeasures> measure_grain_meshes(const Mesh& mesh, double element_size);

}  // namespace polyslip::mesh
