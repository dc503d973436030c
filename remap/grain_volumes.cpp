#include "remap/grain_volumes.hpp"

#include <algorithm>
#include <vector>

#include "core/error.hpp"
#include "remap/donor_average.hpp"

namespace polyslip::remap {
namespace {

using mesh::Field;
using mesh::Location;

struct GrainCompression {
  double volume = 0, reference_volume = 0, pressure = 0;
  double ratio() const { return volume / reference_volume; }
};

/// Sums over the elements of each grain; the pressure is the mean over the grain's volume.
std::vector<GrainCompression> compression_of_grains(const mesh::Snapshot& s, const Field& volume,
                                                    const Field& reference, const Field* pressure) {
  std::vector<GrainCompression> grains(s.mesh.topology.cell_faces.size());
  for (std::size_t e = 0; e < s.mesh.tetrahedra.size(); ++e) {
    GrainCompression& grain = grains[s.mesh.tetrahedron_cell[e]];
    grain.volume += volume.values[e];
    grain.reference_volume += reference.values[e];
    if (pressure) grain.pressure += volume.values[e] * pressure->values[e];
  }
  for (GrainCompression& grain : grains) grain.pressure /= grain.volume;
  return grains;
}

/// Diagonal stresses of minus the pressure of each entity's grain; `each` entities an element.
void set_hydrostatic(Field& stress, const std::vector<int>& cells, std::size_t each,
                     const std::vector<GrainCompression>& grains) {
  for (std::size_t e = 0; e < cells.size(); ++e)
    for (std::size_t q = 0; q < each; ++q)
      for (std::size_t c = 0; c < 3; ++c)
        stress.values[6 * (e * each + q) + c] = -grains[cells[e]].pressure;
}

Field like(const Field& field) {
  Field result = field;
  result.values.clear();
  return result;
}

}  // namespace

void keep_grain_compression(const mesh::Snapshot& old, mesh::Snapshot& fresh) {
  const Field* volume = old.find("volume", Location::element);
  const Field* reference = old.find("reference_volume", Location::element);
  if (!volume || !reference) return;
  const auto grains =
      compression_of_grains(old, *volume, *reference, old.find("pressure", Location::element));
  const auto& cells = fresh.mesh.tetrahedron_cell;
  const auto points = static_cast<std::size_t>(fresh.quadrature_points);
  const auto volumes = point_volumes(fresh);
  Field now = like(*volume), at_zero = like(*reference);
  for (std::size_t e = 0; e < cells.size(); ++e) {
    double sum = 0;
    for (std::size_t q = 0; q < points; ++q) sum += volumes[e * points + q];
    now.values.push_back(sum);
    at_zero.values.push_back(sum / grains[cells[e]].ratio());
  }
  fresh.fields.push_back(std::move(now));
  fresh.fields.push_back(std::move(at_zero));
  if (const Field* ratio = old.find("volume_ratio", Location::quadrature_point)) {
    Field kept = like(*ratio);
    for (const int cell : cells)
      kept.values.insert(kept.values.end(), points, grains[cell].ratio());
    fresh.fields.push_back(std::move(kept));
  }
  if (Field* pressure = fresh.find("pressure", Location::element))
    for (std::size_t e = 0; e < cells.size(); ++e) pressure->values[e] = grains[cells[e]].pressure;
  if (Field* stress = fresh.find("cauchy_stress", Location::element))
    set_hydrostatic(*stress, cells, 1, grains);
  if (Field* stress = fresh.find("cauchy_stress", Location::quadrature_point))
    set_hydrostatic(*stress, cells, points, grains);
}

}  // namespace polyslip::remap
