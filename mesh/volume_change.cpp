#include "mesh/volume_change.hpp"

#include <cmath>

namespace polyslip::mesh {

std::vector<double> cell_volumes(const Tessellation& tessellation) {
  std::vector<double> volumes;
  for (int c = 0; c < tessellation.topology.cell_count(); ++c)
    volumes.push_back(cell_volume(tessellation, c));
  return volumes;
}

VolumeChange volume_change(const std::vector<double>& before, const std::vector<double>& after) {
  VolumeChange result;
  double squares = 0;
  for (std::size_t c = 0; c < before.size(); ++c) {
    const double change = after[c] / before[c] - 1;
    squares += change * change;
    if (std::abs(change) <= std::abs(result.worst)) continue;
    result.worst = change;
    result.worst_cell = static_cast<int>(c);
  }
  result.rms = std::sqrt(squares / static_cast<double>(before.size()));
  return result;
}

}  // namespace polyslip::mesh
