#include "results/analysis/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace polyslip::results::analysis {
namespace {

constexpr double no_spread = 1e-6;  // degrees: undeformed

/// Grains whose spread has one mode in every state in which they have a spread.
std::vector<bool> of_one_mode(const std::vector<std::vector<GrainSpread>>& spreads) {
  std::vector<bool> one(spreads.front().size(), true);
  for (const auto& state : spreads)
    for (std::size_t g = 0; g < state.size(); ++g)
      if (state[g].spread > no_spread && state[g].bimodality > one_mode_bound) one[g] = false;
  return one;
}

std::vector<double> counted_spreads(const std::vector<GrainSpread>& spreads,
                                    const std::vector<bool>& counted) {
  std::vector<double> values;
  for (std::size_t g = 0; g < spreads.size(); ++g)
    if (counted[g]) values.push_back(spreads[g].spread);
  return values;
}

SpreadSummary summarise(double strain, const std::vector<GrainSpread>& spreads,
                        const std::vector<bool>& counted) {
  SpreadSummary s;
  s.strain = strain;
  s.correlation = std::numeric_limits<double>::quiet_NaN();
  double square = 0, volume = 0;
  for (std::size_t g = 0; g < spreads.size(); ++g) {
    if (!counted[g]) continue;
    ++s.grains;
    s.mean += spreads[g].spread;
    square += spreads[g].spread * spreads[g].spread;
    s.volume_mean += spreads[g].volume * spreads[g].spread;
    volume += spreads[g].volume;
  }
  const auto n = static_cast<double>(s.grains);
  s.mean /= n;
  s.volume_mean /= volume;
  s.deviation = std::sqrt(std::max(0.0, square / n - s.mean * s.mean));
  return s;
}

void add_spreads(Analysis& a) {
  for (const RunSample& sample : a.samples)
    a.spreads.push_back(
        grain_spreads(sample, a.spreads.empty() ? std::vector<GrainSpread>{} : a.spreads.back(),
                      a.spreads.empty() ? std::vector<GrainSpread>{} : a.spreads.front()));
  a.counted.assign(a.spreads.front().size(), true);
  if (a.options.inner) a.counted = a.samples.front().inner;
  if (a.options.one_mode) {
    const auto one = of_one_mode(a.spreads);
    for (std::size_t g = 0; g < one.size(); ++g) a.counted[g] = a.counted[g] && one[g];
  }
  if (std::none_of(a.counted.begin(), a.counted.end(), [](bool c) { return c; }))
    throw core::InputError("no grain has one mode at every strain; leave --one-mode out");
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    a.spread_summaries.push_back(summarise(a.samples[i].strain, a.spreads[i], a.counted));
    if (i > 0 && a.spread_summaries[i - 1].mean > no_spread)
      a.spread_summaries[i].correlation = correlation(counted_spreads(a.spreads[i - 1], a.counted),
                                                      counted_spreads(a.spreads[i], a.counted));
  }
}

}  // namespace

Sample Analysis::texture_sample(std::size_t state) const {
  const RunSample& s = samples[state];
  return options.inner && s.meshed ? of_grains(s, s.inner) : s.sample;
}

TextureState texture_of(const Sample& sample, double strain, const AnalysisOptions& options) {
  const Odf odf(sample, options.half_width, options.symmetry);
  TextureState t;
  t.strain = strain;
  t.orientations = static_cast<long>(sample.size());
  for (const Component& c : rolling_components())
    t.components.push_back(
        {c.name, intensity(odf, c), volume_fraction(sample, c, options.fraction_angle)});
  t.integrals = integrals(odf, options.threads);
  t.beta = beta_fibre(odf, options.threads);
  return t;
}

Analysis analyse_folder(const std::string& folder, const AnalysisOptions& options) {
  const StateSeries series(folder);
  if (series.states().empty())
    throw core::InputError(folder +
                           ": holds no stored state; give the folder of a run that has begun, or a "
                           "file of orientations");
  Analysis a;
  a.options = options;
  for (const auto& state : chosen_states(series, options.at_strains))
    a.samples.push_back(read_run_sample(series.path(state)));
  const RunSample& first = a.samples.front();
  if (options.inner && first.meshed &&
      std::none_of(first.inner.begin(), first.inner.end(), [](bool inner) { return inner; }))
    throw core::InputError(folder +
                           ": every grain has a face on the domain boundary; leave --inner "
                           "out");
  for (std::size_t i = 0; i < a.samples.size(); ++i)
    a.textures.push_back(texture_of(a.texture_sample(i), a.samples[i].strain, options));
  if (first.meshed) add_spreads(a);
  return a;
}

Analysis analyse_sample(Sample sample, const AnalysisOptions& options) {
  Analysis a;
  a.options = options;
  RunSample s;
  s.meshed = false;
  s.sample = normalised(std::move(sample));
  for (std::size_t i = 0; i < s.sample.size(); ++i) s.grain.push_back(static_cast<int>(i));
  s.inner.assign(s.sample.size(), true);
  a.textures.push_back(texture_of(s.sample, 0, options));
  a.samples.push_back(std::move(s));
  return a;
}

}  // namespace polyslip::results::analysis
