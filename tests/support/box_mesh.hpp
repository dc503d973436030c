#pragma once
// A structured mesh of a box for tests: cubes of six ten-node tetrahedra (Kuhn), grains as slabs
// along x. All of Mesh is filled in, so that check() and a remeshing work on it.

#include <array>

#include "mesh/mesh.hpp"

namespace polyslip::tests {

/// `cells`: cubes along x, y, z; the number along x is a multiple of `slabs`, the number of grains.
mesh::Mesh box_mesh(const std::array<int, 3>& cells, const core::Vec3& size, int slabs = 1);

/// Moves every interior node by at most `amount` times the spacing (a fixed smooth field), mid
/// nodes kept at mid points, so that elements stay straight but differ in shape.
void distort(mesh::Mesh& mesh, double amount);

}  // namespace polyslip::tests
