#pragma once
// Voronoi tessellation of a box, before and after regularisation.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace polyslip::mesh {

/// n . x = d, |n| = 1
struct Plane {
  core::Vec3 normal = core::Vec3::UnitX();
  double offset = 0;
};

/// What a deck asks for in [polycrystal].
struct PolycrystalOptions {
  int grains = 30;
  std::uint64_t seed = 1;
  core::Vec3 domain{1, 1, 1};  ///< shape of the box; scaled so that grains have unit mean volume
};

/// What a deck asks for in [regularisation].
struct RegularisationOptions {
  double max_edge_length = 0.13;      ///< l_max, for grains of unit mean volume; 0: none
  double max_flatness_fault = 20.0;   ///< f_max [degrees]
};

/// A box [0, size] cut into cells with shared vertices, edges and faces.
struct Tessellation {
  Topology topology;
  core::Vec3 size{1, 1, 1};               ///< box, edge lengths; mean cell volume is 1
  std::vector<core::Vec3> seeds;          ///< one a cell
  std::vector<core::Vec3> vertices;       ///< [topology.vertex_count]
  std::vector<Plane> face_planes;         ///< the face's plane in the Voronoi tessellation (eq. 2)
  /// Master point of a face's interpolation triangles (section 2.1.2.2): -1 the barycentre of the
  /// face's vertices, i >= 0 the i-th vertex of its loop.
  std::vector<int> face_masters;

  void check() const;
};

/// What a regularisation did.
struct RegularisationReport {
  int edges_before = 0, short_before = 0, short_after = 0;
  int deleted = 0, loops = 0;
  int refused_flatness = 0, refused_topology = 0;
  double max_flatness_fault = 0;  ///< degrees, over all faces afterwards
};

/// Box of the right shape whose volume is the number of grains.
core::Vec3 box_size(const PolycrystalOptions& options);

/// Poisson-Voronoi tessellation of the box. Same seed, same result, on any machine or rank count.
Tessellation voronoi_tessellation(const PolycrystalOptions& options);

/// Voronoi tessellation of given seeds, which lie inside the box [0, size].
Tessellation voronoi_tessellation(const std::vector<core::Vec3>& seeds, const core::Vec3& size);

/// Removes short edges (section 2.1.2 of the paper).
RegularisationReport regularise(Tessellation& tessellation, const RegularisationOptions& options);

/// Largest angle [degrees] between the normals of a face's interpolation triangles.
double flatness_fault(const Tessellation& tessellation, int face);

/// Volume of a cell bounded by the interpolation triangles of its faces.
double cell_volume(const Tessellation& tessellation, int cell);

/// Writes the tessellation in Neper's .tess format (as its documentation describes it).
void write_tess(const Tessellation& tessellation, const std::string& path);

}  // namespace polyslip::mesh
