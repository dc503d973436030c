#include <fmt/format.h>

#include "core/error.hpp"
#include "solver/model.hpp"
#include "solver/snapshot_fields.hpp"

namespace polyslip::solver {

using core::Transport;
using mesh::Location;

mesh::Snapshot initial_snapshot(mesh::Mesh mesh, const std::vector<core::Quaternion>& orientations,
                                const material::CrystalLaw& law, int quadrature_points) {
  const auto size = static_cast<std::size_t>(law.layout().size());
  const auto grains = static_cast<std::size_t>(mesh.topology.cell_count());
  if (orientations.size() != grains)
    throw core::InternalError(fmt::format("initial_snapshot: {} orientations for {} grains",
                                          orientations.size(), grains));
  std::vector<double> states(grains * size);
  for (std::size_t g = 0; g < grains; ++g) law.initial_state(orientations[g], &states[g * size]);
  mesh::Snapshot out;
  out.mesh = std::move(mesh);
  out.quadrature_points = quadrature_points;
  const auto slots = static_cast<std::size_t>(point_rule(quadrature_points).slots);
  constexpr std::size_t lanes = material::lanes;
  std::vector<double> blocks;
  blocks.reserve(out.mesh.tetrahedra.size() * size * slots);
  for (const int grain : out.mesh.tetrahedron_cell)
    for (std::size_t block = 0; block < slots / lanes; ++block)
      for (std::size_t c = 0; c < size; ++c)
        blocks.insert(blocks.end(), lanes, states[static_cast<std::size_t>(grain) * size + c]);
  put_state(out, law, blocks);
  put(out,
      mesh::Field{field::displacement, Location::node, 3, "L", Transport::shape_functions,
                  "from the initial position", std::vector<double>(3 * out.mesh.nodes.size(), 0)});
  return out;
}

}  // namespace polyslip::solver
