#include "mesh/boundary_sliding.hpp"

#include <algorithm>
#include <array>

#include "core/parallel.hpp"
#include "mesh/assembly.hpp"
#include "mesh/boundary_slider.hpp"
#include "mesh/mesh.hpp"
#include "mesh/tetrahedral_optimiser.hpp"

namespace polyslip::mesh {
namespace {

/// Powers of 1/rho, round by round: the higher, the more the least radius ratio counts.
constexpr std::array<int, 6> worst_powers{9, 9, 9, 18, 18, 27};

/// Gives each chosen grain its surface's nodes, as they are now, and improves its inside.
template <class Improve>
void follow_surface(const BoundaryMesher& boundary, std::vector<VolumeMesh>& volumes,
                    const std::vector<char>& grains, int threads, const Improve& improve) {
  const auto numbers = boundary.numbers();
  const auto positions = boundary.positions(numbers);
  core::parallel_for(threads, volumes.size(), [&](std::size_t grain) {
    if (!grains[grain]) return;
    const auto surface = grain_surface(boundary.geometry().topology, boundary, numbers, positions,
                                       static_cast<int>(grain), boundary.scale());
    auto& volume = volumes[grain];
    std::copy(surface.mesh.nodes.begin(), surface.mesh.nodes.end(), volume.nodes.begin());
    volume = improve(surface.mesh, volume);
  });
}

/// Nodes of a grain's tetrahedra below `limit`, some of them more than once.
std::vector<int> nodes_of_worst(const VolumeMesh& volume, double limit) {
  std::vector<int> nodes;
  for (const auto& t : volume.tetrahedra)
    if (!(radius_ratio(volume.nodes[t[0]], volume.nodes[t[1]], volume.nodes[t[2]],
                       volume.nodes[t[3]]) >= limit))
      nodes.insert(nodes.end(), t.begin(), t.end());
  return nodes;
}

/// Nodes of surfaces that elements below `limit` have, by number; and the grains of these elements.
struct WorstPlaces {
  std::vector<char> nodes, grains;
  bool any() const { return std::find(grains.begin(), grains.end(), true) != grains.end(); }
};
WorstPlaces worst_places(const BoundaryMesher& boundary, const std::vector<VolumeMesh>& volumes,
                         double limit, int threads) {
  const auto numbers = boundary.numbers();
  const auto positions = boundary.positions(numbers);
  std::vector<std::vector<int>> worst(volumes.size());  // by number
  core::parallel_for(threads, volumes.size(), [&](std::size_t grain) {
    worst[grain] = nodes_of_worst(volumes[grain], limit);
    if (worst[grain].empty()) return;
    const auto ids = grain_surface(boundary.geometry().topology, boundary, numbers, positions,
                                   static_cast<int>(grain), boundary.scale())
                         .numbers;
    for (int& n : worst[grain]) n = n < static_cast<int>(ids.size()) ? ids[n] : -1;
  });
  WorstPlaces result{std::vector<char>(numbers.count, false),
                     std::vector<char>(volumes.size(), false)};
  for (std::size_t grain = 0; grain < volumes.size(); ++grain) {
    result.grains[grain] = !worst[grain].empty();
    for (const int n : worst[grain])
      if (n >= 0) result.nodes[n] = true;
  }
  return result;
}

}  // namespace

void slide_boundary(BoundaryMesher& boundary, std::vector<VolumeMesh>& volumes,
                    double progression_factor, int threads) {
  const auto grains = slide_nodes(boundary, volumes,
                                  {.progression_factor = progression_factor, .threads = threads});
  follow_surface(boundary, volumes, grains, threads, optimise_inside);
}

void raise_worst(BoundaryMesher& boundary, std::vector<VolumeMesh>& volumes,
                 double progression_factor, int threads) {
  for (const int power : worst_powers) {
    auto places = worst_places(boundary, volumes, worst_limit, threads);
    if (!places.any()) return;
    const auto moved = slide_nodes(boundary, volumes,
                                   {.progression_factor = progression_factor,
                                    .threads = threads,
                                    .chosen = std::move(places.nodes),
                                    .power = power});
    for (std::size_t i = 0; i < volumes.size(); ++i) places.grains[i] |= moved[i];
    follow_surface(boundary, volumes, places.grains, threads,
                   [power](const SurfaceMesh& surface, const VolumeMesh& mesh) {
                     return raise_worst_inside(surface, mesh, worst_limit, power);
                   });
  }
}

VolumeMesh raise_worst(const SurfaceMesh& surface, VolumeMesh mesh) {
  for (const int power : worst_powers) mesh = raise_worst_inside(surface, mesh, worst_limit, power);
  return mesh;
}

}  // namespace polyslip::mesh
