#include "results/analysis/run_sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "results/checksum.hpp"
#include "results/orientation_state.hpp"
#include "results/schema.hpp"

namespace polyslip::results::analysis {
namespace {

constexpr double same_strain = 1e-9;
constexpr double nearest_allowed = 0.01;

Sample sample_of(std::span<const double> quaternions, std::vector<double> volumes) {
  Sample s;
  s.weights = std::move(volumes);
  s.orientations.reserve(s.weights.size());
  for (std::size_t i = 0; i < quaternions.size(); i += 4)
    s.orientations.push_back(
        core::Quaternion(quaternions[i], quaternions[i + 1], quaternions[i + 2], quaternions[i + 3])
            .normalized());
  return s;
}

/// Grains without a face on the domain boundary.
std::vector<bool> inner_grains(TableReader& reader, int grains) {
  std::vector<bool> inner(static_cast<std::size_t>(grains), true);
  const auto cells = reader.get<std::int32_t>("topology/face_cells");
  const auto domain = reader.get<std::int32_t>("topology/face_domain");
  for (std::size_t face = 0; face < domain.size(); ++face)
    if (domain[face] >= 0)
      for (const std::size_t side : {2 * face, 2 * face + 1})
        if (cells[side] >= 0) inner.at(static_cast<std::size_t>(cells[side])) = false;
  return inner;
}

}  // namespace

RunSample read_run_sample(const std::string& path) {
  RunSample s;
  s.meshed = !holds_orientations_only(path);
  const auto file = hdf5::File::open(path);
  TableReader reader(file);
  s.strain = reader.get_scalar<double>("strain");
  auto volumes = reader.get<double>("elements/volume");
  s.sample = sample_of(reader.get<double>("elements/orientation"), std::move(volumes));
  int grains = 0;
  for (const int number : reader.get<std::int32_t>("mesh/grain")) {
    s.grain.push_back(number - 1);
    grains = std::max(grains, number);
  }
  s.inner = s.meshed ? inner_grains(reader, grains)
                     : std::vector<bool>(static_cast<std::size_t>(grains), true);
  return s;
}

Sample of_grains(const RunSample& sample, const std::vector<bool>& keep) {
  Sample part;
  for (std::size_t i = 0; i < sample.sample.size(); ++i) {
    if (!keep.at(static_cast<std::size_t>(sample.grain[i]))) continue;
    part.orientations.push_back(sample.sample.orientations[i]);
    part.weights.push_back(sample.sample.weights[i]);
  }
  if (part.size() == 0) throw core::InternalError("texture: no grain is left");
  return part;
}

std::vector<StateRecord> chosen_states(const StateSeries& series,
                                       const std::vector<double>& strains) {
  std::vector<StateRecord> distinct;
  for (const auto& state : series.states())
    if (distinct.empty() || std::abs(state.strain - distinct.back().strain) > same_strain)
      distinct.push_back(state);
  if (distinct.empty()) throw core::InputError("the run has stored no state yet");
  if (strains.empty()) return distinct;
  std::vector<bool> wanted(distinct.size(), false);
  for (const double strain : strains) {
    const auto nearest =
        std::min_element(distinct.begin(), distinct.end(), [&](const auto& a, const auto& b) {
          return std::abs(a.strain - strain) < std::abs(b.strain - strain);
        });
    if (!(std::abs(nearest->strain - strain) <= nearest_allowed))
      throw core::InputError(
          fmt::format("no state is stored within {} of strain {}; the nearest is at {:.6g}",
                      nearest_allowed, strain, nearest->strain));
    wanted[static_cast<std::size_t>(nearest - distinct.begin())] = true;
  }
  std::vector<StateRecord> chosen;
  for (std::size_t i = 0; i < distinct.size(); ++i)
    if (wanted[i]) chosen.push_back(distinct[i]);
  return chosen;
}

}  // namespace polyslip::results::analysis
