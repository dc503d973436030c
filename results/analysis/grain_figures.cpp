#include "results/analysis/grain_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace polyslip::results::analysis {
namespace {

using core::Vec3;

constexpr double grain_half_width = 0.07;  // rad, about 4 degrees: one grain is sharp

Sample grain_of(const RunSample& sample, int grain) {
  std::vector<bool> keep(sample.inner.size(), false);
  keep.at(static_cast<std::size_t>(grain)) = true;
  return of_grains(sample, keep);
}

/// The upper ends of the four <111> axes of a crystal through all states, cut where they cross the
/// rim.
std::vector<std::vector<Place>> pole_paths(const Analysis& a, std::size_t grain) {
  std::vector<std::vector<Place>> paths;
  for (const Vec3& h : crystal_family({1, 1, 1})) {
    if (h[2] < 0) continue;
    std::vector<Place> path;
    bool up = true;
    for (std::size_t i = 0; i < a.spreads.size(); ++i) {
      const Vec3 pole = a.spreads[i][grain].mean * h;
      const bool now_up = pole[2] >= 0;
      if (!path.empty() && now_up != up) {
        paths.push_back(path);
        path.clear();
      }
      up = now_up;
      path.push_back(equal_area(now_up ? pole : Vec3(-pole)));
    }
    paths.push_back(path);
  }
  return paths;
}

}  // namespace

GrainPicture grain_picture(const Analysis& a, int grain) {
  const auto at = static_cast<std::size_t>(grain);
  const Sample sample = grain_of(a.samples.back(), grain);
  return {grain, pole_paths(a, at),
          disc_grid(PoleFigure(sample, {1, 1, 1}, grain_half_width), 61, a.options.threads),
          disorientation_vectors(sample, a.spreads.back()[at].mean)};
}

std::vector<int> drawn_grains(const Analysis& a, const std::vector<int>& asked) {
  const auto& grains = a.spreads.back();
  const int count = static_cast<int>(grains.size());
  for (const int g : asked)
    if (g < 0 || g >= count)
      throw core::InputError(fmt::format("grain {}: there are {} grains", g + 1, count));
  if (!asked.empty()) return asked;
  std::vector<int> order;
  for (int g = 0; g < count; ++g)
    if (a.counted[static_cast<std::size_t>(g)]) order.push_back(g);
  std::ranges::stable_sort(order, [&](int i, int j) {
    return grains[static_cast<std::size_t>(i)].volume > grains[static_cast<std::size_t>(j)].volume;
  });
  if (order.size() > 2) order.erase(order.begin() + 2, order.end());
  return order;
}

std::vector<Plot> grain_plots(const Analysis& a, const GrainPicture& picture) {
  std::vector<Plot> plots;
  const char* names[] = {"about RD (degrees)", "about TD (degrees)", "about ND (degrees)"};
  for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
    Series s{"", Mark::points, {}, {}};
    for (const Vec3& v : picture.deviations) {
      s.x.push_back(v[i]);
      s.y.push_back(v[j]);
    }
    plots.push_back(
        {fmt::format("Grain {} at strain {:.4g}", picture.grain + 1, a.samples.back().strain),
         {names[i]},
         {names[j]},
         {s}});
  }
  return plots;
}

std::string path_svg(const Analysis& a, const std::vector<GrainPicture>& pictures) {
  std::vector<MapPanel> panels;
  for (const GrainPicture& picture : pictures) {
    const GrainSpread& last = a.spreads.back()[static_cast<std::size_t>(picture.grain)];
    panels.push_back(
        pole_figure_panel(picture.poles, fmt::format("grain {}, {{111}}", picture.grain + 1)));
    panels.back().paths = picture.paths;
    panels.back().below =
        fmt::format("turned {:.1f}, spread {:.1f} degrees", last.rotation, last.spread);
  }
  return map_svg(panels, 3,
                 fmt::format("Rotation paths of grains to strain {:.4g} and their orientations "
                             "there",
                             a.samples.back().strain));
}

}  // namespace polyslip::results::analysis
