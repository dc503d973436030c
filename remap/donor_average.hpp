#pragma once
// Element means of fields at quadrature points, in the current configuration.

#include <vector>

#include "core/types.hpp"
#include "mesh/snapshot.hpp"

namespace polyslip::remap {

/// w_q det J_q of every quadrature point, [elements][points]: the volume that a point stands for.
std::vector<double> point_volumes(const mesh::Snapshot& snapshot);

/// Volume-weighted mean of a quadrature-point field over each element, [elements][components];
/// unit quaternions (Transport::orientation_average) by the eigenvector of the largest eigenvalue
/// of sum v q q^T, with the sign of the first point.
std::vector<double> element_means(const mesh::Snapshot& snapshot, const mesh::Field& field);

/// Mean orientation of each grain, weighted by volume; [grains].
std::vector<core::Quaternion> grain_orientations(const mesh::Snapshot& snapshot);

}  // namespace polyslip::remap
