#pragma once
// Regularised, meshed polycrystals of a wanted size, for benchmarks.

#include <cstdint>

#include "mesh/mesh.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::tests {

/// A cube of Voronoi grains of unit volume in all, regularised with the default options; quadratic
/// tetrahedra, element_size for grains of unit mean volume.
mesh::Mesh polycrystal_mesh(mesh::MesherPool& pool, int grains, double element_size,
                            std::uint64_t seed = 1);

/// Number of grains that gives about so many elements.
int grains_for(double elements, double element_size);

}  // namespace polyslip::tests
