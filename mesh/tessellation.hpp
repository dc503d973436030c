#pragma once
// Voronoi tessellation of a convex domain, before and after regularisation.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/domain.hpp"
#include "mesh/topology.hpp"

namespace polyslip::mesh {

/// Arrangements of seeds. A regular one has one a cube of its grid, or two (body-centred: truncated
/// octahedra) or four (face-centred: rhombic dodecahedra).
enum class Morphology {
  voronoi,
  columnar,
  bamboo,
  columnar_equiaxed,
  cubes,
  truncated_octahedra,
  rhombic_dodecahedra,
  laguerre,
  grain_growth  ///< laguerre with the distributions of normal grain growth
};

/// Distributions that a Laguerre polycrystal is to have. Equivalent diameters are lognormal; one
/// minus the sphericity is lognormal, so that sphericities have the given mean and standard
/// deviation. The defaults are those of normal grain growth.
struct GrainDistributions {
  /// Standard deviation of the grains' equivalent diameters over their mean; the mean follows from
  /// the unit mean volume.
  double diameter_deviation = 0.35;
  double sphericity_mean = 0.855;
  double sphericity_deviation = 0.03;
};

/// What a deck asks for in [polycrystal].
struct PolycrystalOptions {
  int grains = 30;
  std::uint64_t seed = 1;
  core::Vec3 domain{1, 1, 1};    ///< its extents; scaled so that grains have unit mean volume
  std::string shape = "box";     ///< "box", "cylinder", "sphere" or "half-spaces"
  int axis = 2;                  ///< of cylinders, columns and bamboo
  double faceting_error = 1e-2;  ///< largest excess of the volume of faceted cylinders and spheres
  std::vector<std::array<double, 4>> half_spaces{};  ///< (n, d): n . x <= d
  Morphology morphology = Morphology::voronoi;
  core::Vec3 stretch{1, 1, 1};                ///< of the grains; only the ratios count
  double columnar_share = 0.5;                ///< of the height, of columnar-equiaxed
  std::optional<std::array<int, 3>> cells{};  ///< cubes of a regular grid; then they make the box
  GrainDistributions distributions{};         ///< of laguerre
  std::array<bool, 3> periodic{false, false, false};  ///< directions in which the box repeats
  std::vector<core::Vec3> seeds{};  ///< if given, in the unit of `domain` or `half_spaces`
};

/// What a deck asks for in [regularisation].
struct RegularisationOptions {
  double max_edge_length = 0.13;     ///< l_max, for grains of unit mean volume; 0: no deletions
  double max_flatness_fault = 20.0;  ///< f_max [degrees]; 0: none
  /// Beyond the paper, which never lets two faces of a cell share a polyline of two edges: edges
  /// below this share of l_max, and those of any length opposite to a corner of a triangular face
  /// below this angle [degrees], may be deleted although they leave one, for they spoil the mesh
  /// most.
  double polyline_share = 0.1;
  double min_corner_angle = 6.0;
  /// Beyond the paper: where the least-squares position of a new vertex (eq. 2) leaves a flatness
  /// fault above f_max, but not above this times f_max, a better one is sought nearby; 1: never.
  double position_search = 1.2;
  /// Beyond the paper: so many times, once nothing more can be deleted, vertices move to where
  /// their faces are flatter; then deletion goes on.
  int flattening_sweeps = 1;

  /// The paper's rules: the same, without what goes beyond them.
  RegularisationOptions as_in_the_paper() const {
    RegularisationOptions o = *this;
    o.polyline_share = o.min_corner_angle = 0;
    o.position_search = 1;
    o.flattening_sweeps = 0;
    return o;
  }
};

/// A convex domain cut into cells with shared vertices, edges and faces.
struct Tessellation {
  Topology topology;
  Domain domain = box_domain({1, 1, 1});
  core::Vec3 size{1, 1, 1};          ///< of the domain's bounding box; mean cell volume is 1
  std::vector<core::Vec3> seeds;     ///< one a cell
  std::vector<double> weights;       ///< of a Laguerre tessellation, one a cell; else empty
  std::vector<core::Vec3> vertices;  ///< [topology.vertex_count]
  std::vector<Plane> face_planes;    ///< the face's plane in the Voronoi tessellation (eq. 2)
  /// Master point of a face's interpolation triangles (section 2.1.2.2): -1 the barycentre of the
  /// face's vertices, i >= 0 the i-th vertex of its loop.
  std::vector<int> face_masters;

  /// Throws InternalError unless the topology holds, vertices lie in the domain and those of domain
  /// faces on them (exactly if these lie along the axes), faces are unfolded in projection along
  /// their mean normal, and cells have positive volumes that add up to the domain's.
  void check() const;
};

/// What a regularisation did.
struct RegularisationReport {
  int edges_before = 0, short_before = 0, short_after = 0;
  int deleted = 0, loops = 0;
  /// Why short edges stay; they add up to short_after.
  struct Refused {
    int flatness = 0;  ///< a face would be distorted beyond f_max
    int fold = 0;      ///< a face or a cell would fold
    int topology = 0;  ///< a cell would not stay a polyhedron of four faces or more
    int polyline = 0;  ///< two faces of a cell would share a polyline of two edges
    int domain = 0;    ///< the domain would lose a corner or an edge
    int sum() const { return flatness + fold + topology + polyline + domain; }
  } refused;
  double max_flatness_fault = 0;  ///< degrees, over all faces afterwards
};

/// Box of the right shape whose volume is the number of grains.
core::Vec3 box_size(const PolycrystalOptions& options);

/// The polycrystal that a deck asks for: Poisson-Voronoi unless it names another morphology. Faces
/// are numbered in the order of their first cell, vertices and edges in that of their first face.
/// InputError if the options describe no body or seeds lie outside it or coincide. Same seed, same
/// result, on any machine or rank count.
Tessellation voronoi_tessellation(const PolycrystalOptions& options);

/// Voronoi tessellation of given seeds, which lie inside the domain (InputError otherwise,
/// or if two coincide). Vertices within 1e-10 of the cell size are one; where that leaves cells
/// that disagree (more than four that nearly meet in a point), within 1e-9, 1e-8 or 1e-7. Seeds
/// that miss a grid by about 1e-11 are moved onto it.
Tessellation voronoi_tessellation(const std::vector<core::Vec3>& seeds, const Domain& domain);
/// In the box [0, size].
Tessellation voronoi_tessellation(const std::vector<core::Vec3>& seeds, const core::Vec3& size);

/// Laguerre tessellation: cell i is where |x - seed_i|^2 - weight_i is least. Seeds lie inside the
/// domain, though not always in their own cells. InputError, naming the seed, if a cell is empty.
Tessellation laguerre_tessellation(const std::vector<core::Vec3>& seeds,
                                   const std::vector<double>& weights, const Domain& domain);

/// Removes short edges (section 2.1.2 of the paper). Every cell remains a polyhedron that is seen
/// as a whole from its centroid, the box keeps its corners, edges and faces, and face_planes stay
/// those of the Voronoi tessellation. Doing it twice changes nothing. Throws InputError for options
/// out of range.
RegularisationReport regularise(Tessellation& tessellation, const RegularisationOptions& options);

/// Largest angle [degrees] between the normals of a face's interpolation triangles.
double flatness_fault(const Tessellation& tessellation, int face);

/// Volume of a cell bounded by the interpolation triangles of its faces.
double cell_volume(const Tessellation& tessellation, int cell);

/// Writes the tessellation in Neper's .tess format (as its documentation describes it).
void write_tess(const Tessellation& tessellation, const std::string& path);

}  // namespace polyslip::mesh
