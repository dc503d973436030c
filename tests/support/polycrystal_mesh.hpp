#pragma once
// A regularised and meshed random polycrystal, as the program makes them.

#include "mesh/geometry.hpp"

namespace polyslip::tests {

/// A cube of `grains` grains of unit mean volume; element_size: c_l.
inline mesh::Mesh polycrystal_mesh(mesh::MesherPool& pool, int grains, double element_size) {
  mesh::PolycrystalOptions p;
  p.grains = grains;
  auto tessellation = mesh::voronoi_tessellation(p);
  mesh::regularise(tessellation, {});
  mesh::MeshingOptions options;
  options.element_size = element_size;
  mesh::MeshingReport report;
  return mesh::mesh_geometry(mesh::geometry_of(tessellation), options, {1, 1, 1}, pool, report);
}

}  // namespace polyslip::tests
