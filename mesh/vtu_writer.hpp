#pragma once
// Meshes and tessellations as VTK's unstructured grids (.vtu), for ParaView.

#include <string>

#include "mesh/mesh_formats.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

/// Tetrahedra of order 1 (VTK_TETRA) or 2 (VTK_QUADRATIC_TETRA, whose last two mid nodes change
/// places against Gmsh's), with cell data `grain`, `radius_ratio` and, with orientations,
/// `orientation` (w x y z of the rotation that turns crystal axes into sample axes). Arrays are
/// appended raw, in this machine's byte order. Written beside and renamed; InputError if that
/// fails.
void write_vtu(const Mesh& mesh, const std::string& path, const GrainNotes& notes = {});

/// Cells as polyhedra (VTK_POLYHEDRON): a face in a plane is one polygon, another its interpolation
/// triangles. Cell data `grain`, `volume`, `face_count` and, with orientations, `orientation`.
void write_vtu(const Tessellation& tessellation, const std::string& path,
               const GrainNotes& notes = {});

}  // namespace polyslip::mesh
