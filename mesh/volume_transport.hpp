#pragma once
// Weights of a Laguerre tessellation whose cells have asked volumes.

#include <Eigen/Sparse>
#include <optional>
#include <vector>

#include "mesh/power_diagram.hpp"

namespace polyslip::mesh {

/// Derivative of the cells' volumes by the weights, symmetric, without its null space (a common
/// constant): H_ij = -A_ij / (2 |x_i - x_j|), rows that add up to (almost) zero.
Eigen::SparseMatrix<double> volume_derivative(const std::vector<PowerCell>& cells,
                                              const std::vector<core::Vec3>& seeds);

/// Changes the weights until each cell's volume is within `tolerance` (a share of its target) of
/// its target, by Newton's method damped so that no cell becomes empty (Kitagawa, Merigot, Thibert,
/// J. Eur. Math. Soc. 21, 2019). Targets add up to the domain's volume. The cells, or nothing if a
/// cell is empty at the start or no step helps; `seeds` is then as it was.
std::optional<std::vector<PowerCell>> reach_volumes(PowerSeeds& seeds, const Domain& domain,
                                                    const std::vector<double>& targets,
                                                    double tolerance);

}  // namespace polyslip::mesh
