#include "results/report/state_values.hpp"

#include <cmath>
#include <limits>

#include "core/rotation.hpp"
#include "core/tensor.hpp"
#include "mesh/measures.hpp"
#include "results/distribution.hpp"

namespace polyslip::results::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

enum Index { g, slip, equivalent_strain, mises, pressure, spread, radius_ratio };

/// Means and volumes of the grains; elements are sorted by grain.
void average_grains(const mesh::Mesh& mesh, StateValues& s) {
  const int grains = mesh.topology.cell_count();
  s.grain_orientation.assign(grains, {nan, nan, nan, nan});
  s.grain_volume.assign(grains, 0);
  for (std::size_t first = 0, last = 0; first < s.volume.size(); first = last) {
    const int grain = mesh.tetrahedron_cell[first];
    while (last < s.volume.size() && mesh.tetrahedron_cell[last] == grain)
      s.grain_volume[grain] += s.volume[last++];
    if (s.orientation[first].coeffs().allFinite())
      s.grain_orientation[grain] =
          core::mean_rotation(std::span(s.orientation).subspan(first, last - first),
                              std::span(s.volume).subspan(first, last - first));
  }
}

}  // namespace

const std::array<Quantity, quantity_count>& quantities() {
  static const std::array<Quantity, quantity_count> all{
      {{"g", "slip resistance g", "MPa"},
       {"slip", "accumulated slip", ""},
       {"equivalent_strain", "equivalent plastic strain", ""},
       {"von_mises", "von Mises stress", "MPa"},
       {"pressure", "pressure", "MPa"},
       {"spread", "disorientation from the grain's mean", "°"},
       {"radius_ratio", "radius ratio of the element", ""}}};
  return all;
}

double von_mises(const core::Vec6& stress) {
  core::Mat3 s;
  s << stress[0], stress[5], stress[4], stress[5], stress[1], stress[3], stress[4], stress[3],
      stress[2];
  return core::equivalent_stress(s);
}

StateValues values_of(const mesh::Snapshot& snapshot) {
  ElementTable table = element_values(snapshot, ElementValue::average);
  StateValues s;
  s.volume = std::move(table.volume);
  s.orientation = std::move(table.orientation);
  average_grains(snapshot.mesh, s);
  s.values[g] = std::move(table.g);
  s.values[slip] = std::move(table.slip);
  s.values[equivalent_strain] = std::move(table.equivalent_strain);
  s.values[pressure] = std::move(table.pressure);
  for (int e = 0; e < snapshot.mesh.element_count(); ++e) {
    const auto& mean = s.grain_orientation[snapshot.mesh.tetrahedron_cell[e]];
    s.values[mises].push_back(von_mises(table.cauchy_stress[e]));
    s.values[spread].push_back(core::degrees_per_radian *
                               core::disorientation_angle(s.orientation[e], mean));
    s.values[radius_ratio].push_back(mesh::measure_element(snapshot.mesh, e).radius_ratio);
  }
  return s;
}

Range range_of(const std::vector<double>& values, const std::vector<double>& volume) {
  const Distribution d = describe(values);
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) {
      sum += volume[i] * values[i];
      total += volume[i];
    }
  return {d.min, d.max, sum / total, d.percentile(1), d.percentile(99)};
}

}  // namespace polyslip::results::report
