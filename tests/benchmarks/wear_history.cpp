// How the elements of a run wear: `wear_history RUN_FOLDER`, one line a stored state; in the frame
// of sizes of a deck that leaves the shares as they are.

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "core/error.hpp"
#include "remap/remesh.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace {

using namespace polyslip;

/// The predictor's departure from the homogeneous motion; zero in a state without it.
std::vector<core::Vec3> rates_of(const mesh::Snapshot& snapshot) {
  std::vector<core::Vec3> rates(snapshot.mesh.nodes.size(), core::Vec3::Zero());
  if (const auto* f = snapshot.find("solver_rate", mesh::Location::node))
    for (std::size_t n = 0; n < rates.size(); ++n)
      rates[n] = {f->values[3 * n], f->values[3 * n + 1], f->values[3 * n + 2]};
  return rates;
}

/// Of the mesh of a state, what its frame of sizes is made of (remap/isotropy_frame.hpp).
struct Sizes {
  int mesh_number = -1;
  core::Mat3 frame = core::Mat3::Identity();
};

void print(const mesh::Snapshot& s, Sizes& sizes) {
  remap::WearOptions options;
  options.inversion_strain = 0.2;
  const core::Mat3 isotropy = remap::isotropy_frame(remap::initial_positions(s), s.mesh.nodes);
  if (s.mesh_number != sizes.mesh_number)  // its first state is that as the mesher left it
    sizes = {s.mesh_number, remap::size_frame(remap::meshing_scale(s.mesh, {}), isotropy)};
  const auto rates = rates_of(s);
  const auto wear = remap::measure_wear(s.mesh.tetrahedra, s.mesh.nodes, rates,
                                        sizes.frame * isotropy, options, 1);
  fmt::print("{:8.4f} {:5d} {:9d} {:8.4f} {:8.4f} {:8.3f} {:9.4f}\n", s.strain, s.mesh_number,
             s.mesh.element_count(), wear.worst_radius_ratio, wear.worst_jacobian,
             100 * wear.poor_share, wear.inversion_strain);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: wear_history RUN_FOLDER\n");
    return 2;
  }
  try {
    const results::StateSeries series(argv[1]);
    fmt::print("  strain  mesh  elements  radius  jacobian  poor, %  inversion\n");
    Sizes sizes;
    for (const auto& state : series.states()) print(results::read_state(series.path(state)), sizes);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
