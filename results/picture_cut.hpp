#pragma once
// A look inside a polycrystal.

#include "mesh/mesh.hpp"

namespace polyslip::results {

/// The mesh, for a picture, without the grains whose centroids lie in the eighth of the domain that
/// is nearest the eye (x high, y low, z high): faces between those and others are outer ones.
mesh::Mesh without_nearest_eighth(const mesh::Mesh& mesh);

}  // namespace polyslip::results
