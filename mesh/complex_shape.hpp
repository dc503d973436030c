#pragma once
// Shape of a cell complex around a vertex: where a vertex fits best, and whether faces and cells
// are sound.

#include <vector>

#include "core/types.hpp"
#include "mesh/cell_complex.hpp"

namespace polyslip::mesh {

/// Eq. (2) of the paper: the point of least squared distances to the faces' planes in the Voronoi
/// tessellation. Here and below the vertex stays on its domain faces, and where the planes leave
/// its position open it stays near where it is. `faces`: those at the vertex.
core::Vec3 least_squares_position(const CellComplex& complex, int vertex,
                                  const std::vector<int>& faces);

/// The same with the faces' mean planes as they are now (normal the vector area's, through the mean
/// of the face's other vertices), those in the Voronoi tessellation at half the weight.
core::Vec3 flattest_position(const CellComplex& complex, int vertex, const std::vector<int>& faces);

/// Chooses the master points of the faces and stores them with their flatness faults. The largest
/// fault (squared chord); infinite as soon as a face is turned away from its first plane or folded.
double fit_faces(CellComplex& complex, const std::vector<int>& faces);

/// Whether each cell at the vertex is seen as a whole, and right side out, from its centroid: then
/// its faces cannot cross one another.
bool cells_sound(const CellComplex& complex, int vertex);

}  // namespace polyslip::mesh
