#pragma once
// By how much the cells of a tessellation grow and shrink.

#include <vector>

#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

/// [cells]
std::vector<double> cell_volumes(const Tessellation& tessellation);

/// Relative to the volumes before: what a regularisation takes from one cell goes to others.
struct VolumeChange {
  double rms = 0, worst = 0;
  int worst_cell = -1;  ///< -1: none changed
};
VolumeChange volume_change(const std::vector<double>& before, const std::vector<double>& after);

}  // namespace polyslip::mesh
