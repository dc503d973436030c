// What transport alone changes: `transport_options RUN_FOLDER` carries the state before each
// remeshing of a run to the mesh after it, by every option, and compares the grains.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>

#include "core/rotation.hpp"
#include "remap/grain_statistics.hpp"
#include "remap/transport.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace {

using namespace polyslip;

struct Changes {
  double rotation = 0, worst_rotation = 0;  // degrees
  double spread = 0;                        // of the mean over the grains, relative
  double g = 0;                             // rms over the grains, relative
};

Changes changes(const std::vector<remap::GrainStatistics>& before,
                const std::vector<remap::GrainStatistics>& after) {
  Changes c;
  double old_spread = 0, new_spread = 0;
  const auto n = static_cast<double>(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double turned =
        before[i].orientation.angularDistance(after[i].orientation) * core::degrees_per_radian;
    c.rotation += turned / n;
    c.worst_rotation = std::max(c.worst_rotation, turned);
    old_spread += before[i].spread;
    new_spread += after[i].spread;
    c.g += std::pow(after[i].g.mean / before[i].g.mean - 1, 2) / n;
  }
  c.spread = new_spread / old_spread - 1;
  c.g = std::sqrt(c.g);
  return c;
}

void compare(const mesh::Snapshot& before, const mesh::Snapshot& after) {
  const auto old = remap::grain_statistics(before);
  const double per_grain =
      static_cast<double>(before.mesh.element_count()) / static_cast<double>(old.size());
  for (const char* option : {"element", "point", "corrected"}) {
    const auto carried = remap::transport(before, after.mesh, {option, "zero"}, 2);
    const Changes c = changes(old, remap::grain_statistics(carried));
    fmt::print("{:7.4f} {:9.0f} {:>10} {:9.4f} {:9.4f} {:9.3f} {:10.4f}\n", before.strain,
               per_grain, option, c.rotation, c.worst_rotation, 100 * c.spread, 100 * c.g);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: transport_options RUN_FOLDER\n");
    return 2;
  }
  try {
    const results::StateSeries series(argv[1]);
    const auto& states = series.states();
    fmt::print(" strain elements/g  transport  rotation     worst  spread %  g, rms %\n");
    for (std::size_t i = 1; i < states.size(); ++i)
      if (states[i].mesh_number != states[i - 1].mesh_number)
        compare(results::read_state(series.path(states[i - 1])),
                results::read_state(series.path(states[i])));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
