#include "results/analysis/analysis_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace polyslip::results::analysis {
namespace {

constexpr double undeformed = 1e-6;  // degrees of spread
constexpr double bin = 0.5;          // degrees

std::string strain_label(double strain) { return fmt::format("strain {:.4g}", strain); }

/// At most seven of the states, evenly, the last among them: more cannot be told apart.
std::vector<std::size_t> some_states(std::size_t count) {
  std::vector<std::size_t> some;
  const std::size_t wanted = std::min<std::size_t>(count, 7);
  for (std::size_t i = 0; i < wanted; ++i)
    some.push_back(wanted == 1 ? count - 1 : i * (count - 1) / (wanted - 1));
  return some;
}

}  // namespace

bool has_spread(const Analysis& a, std::size_t state) {
  return state < a.spread_summaries.size() && a.spread_summaries[state].mean > undeformed;
}

std::vector<Plot> component_plots(const Analysis& a) {
  Plot intensity{"Components", {"strain"}, {"intensity (times random)"}, {}};
  Plot fraction{"Components", {"strain"}, {"volume fraction"}, {}};
  for (std::size_t c = 0; c < a.textures.front().components.size(); ++c) {
    Series f{a.textures.front().components[c].name, Mark::line, {}, {}}, v = f;
    for (const auto& t : a.textures) {
      f.x.push_back(t.strain);
      v.x.push_back(t.strain);
      f.y.push_back(t.components[c].intensity);
      v.y.push_back(t.components[c].volume_fraction);
    }
    if (a.textures.size() == 1) f.mark = v.mark = Mark::points;
    intensity.series.push_back(std::move(f));
    fraction.series.push_back(std::move(v));
  }
  return {intensity, fraction};
}

std::vector<Plot> beta_plots(const Analysis& a) {
  Plot ridge{"beta-fibre, largest within 15 degrees", {"phi2 (degrees)"}, {"times random"}, {}};
  Plot ideal{"beta-fibre, ideal places", {"phi2 (degrees)"}, {"times random"}, {}};
  for (const std::size_t i : some_states(a.textures.size())) {
    Series r{strain_label(a.textures[i].strain), Mark::line, {}, {}}, f = r;
    for (const auto& p : a.textures[i].beta) {
      r.x.push_back(p.phi2);
      f.x.push_back(p.phi2);
      r.y.push_back(p.ridge_intensity);
      f.y.push_back(p.ideal_intensity);
    }
    ridge.series.push_back(std::move(r));
    ideal.series.push_back(std::move(f));
  }
  return {ridge, ideal};
}

std::vector<Plot> spread_plots(const Analysis& a) {
  Plot plot{"In-grain spreads", {"mean disorientation of a grain (degrees)"}, {"density"}, {}};
  double largest = 0;
  for (const auto& state : a.spreads)
    for (const auto& g : state) largest = std::max(largest, g.spread);
  const int bins = static_cast<int>(std::ceil(largest / bin)) + 1;
  for (const std::size_t i : some_states(a.spreads.size())) {
    if (!has_spread(a, i)) continue;
    Histogram histogram(0, bins * bin, bins);
    for (std::size_t g = 0; g < a.spreads[i].size(); ++g)
      if (a.counted[g]) histogram.add(a.spreads[i][g].spread);
    plot.series.push_back(
        steps_of(histogram, fmt::format("{}: mean {:.2f}", strain_label(a.samples[i].strain),
                                        a.spread_summaries[i].mean)));
  }
  return {plot};
}

std::vector<Plot> correlation_plots(const Analysis& a) {
  std::vector<Plot> plots;
  for (std::size_t i = 1; i < a.spreads.size(); ++i) {
    if (!has_spread(a, i - 1)) continue;
    Series s{fmt::format("r = {:.3f}", a.spread_summaries[i].correlation), Mark::points, {}, {}};
    for (std::size_t g = 0; g < a.spreads[i].size(); ++g) {
      if (!a.counted[g]) continue;
      s.x.push_back(a.spreads[i - 1][g].spread);
      s.y.push_back(a.spreads[i][g].spread);
    }
    plots.push_back({"In-grain spreads",
                     {fmt::format("at strain {:.4g} (degrees)", a.samples[i - 1].strain)},
                     {fmt::format("at strain {:.4g} (degrees)", a.samples[i].strain)},
                     {s}});
  }
  return plots;
}

}  // namespace polyslip::results::analysis
