// Figures 2, 3, 5, 6 and 7: grains, faces and edges, raw and regularised.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "figures.hpp"
#include "mesh/measures.hpp"

namespace polyslip::figures {
namespace {

using results::Mark;
using results::Plot;
using results::Series;
using Doubles = std::vector<double>;

/// Of the inner grains of several cubes; flatness faults of all faces (fig. 6).
struct Gathered {
  long grains = 0, inner = 0;
  Doubles sizes, faces, edges, edge_lengths, face_diameters, faults;
};

Options with_defaults(Options options, int cubes, int grains) {
  if (options.cubes == 0) options.cubes = cubes;
  if (options.grains == 0) options.grains = grains;
  return options;
}

void add(Gathered& g, const mesh::Tessellation& tessellation) {
  const mesh::Measures m = mesh::measure(tessellation);
  Doubles diameters;
  for (const auto& grain : m.grains) {
    ++g.grains;
    if (!grain.inner) continue;
    ++g.inner;
    diameters.push_back(grain.diameter());
    g.faces.push_back(grain.faces);
    g.edges.push_back(grain.edges);
  }
  const double mean = results::describe(diameters).mean;
  for (const double d : diameters) g.sizes.push_back(d / mean);
  for (const auto& edge : m.edges)
    if (edge.inner) g.edge_lengths.push_back(edge.length);
  for (const auto& face : m.faces) {
    if (face.inner) g.face_diameters.push_back(face.diameter());
    g.faults.push_back(face.flatness_fault);
  }
}

/// The same cubes for each setting; without one, as they grew.
Gathered gather(const Options& options,
                const std::optional<mesh::RegularisationOptions>& regularisation) {
  Gathered g;
  for (int cube = 0; cube < options.cubes; ++cube) {
    mesh::PolycrystalOptions polycrystal;
    polycrystal.grains = options.grains;
    polycrystal.seed = options.seed + static_cast<std::uint64_t>(cube);
    mesh::Tessellation tessellation = mesh::voronoi_tessellation(polycrystal);
    if (regularisation) mesh::regularise(tessellation, *regularisation);
    add(g, tessellation);
  }
  return g;
}

double mean(const Doubles& values) { return results::describe(values).mean; }

double share_below(const Doubles& values, double bound) {
  const auto n = std::count_if(values.begin(), values.end(), [&](double v) { return v < bound; });
  return static_cast<double>(n) / static_cast<double>(values.size());
}

std::string counted(const Options& o, const Gathered& g) {
  return fmt::format("{} x {} grains, {} of them inner.\n\n", o.cubes, o.grains, g.inner);
}

/// Share of the grains that have each number of faces.
Series face_numbers(const Doubles& faces, const std::string& label, Mark mark) {
  results::Histogram h(0.5, 40.5, 40);
  for (const double f : faces) h.add(f);
  Series s{label, mark, {}, h.density()};
  for (int i = 1; i <= 40; ++i) s.x.push_back(i);
  while (!s.y.empty() && s.y.back() == 0) {
    s.x.pop_back();
    s.y.pop_back();
  }
  return s;
}

/// J.-S. Ferenc and Z. Neda (Physica A 385, 2007): the density of v = V/<V> in an endless
/// Poisson-Voronoi tessellation is close to 3125/24 v^4 exp(-5 v). Here that of r = R/<R>, where
/// v = (m r)^3 and m = <v^(1/3)> = Gamma(16/3)/(Gamma(5) 5^(1/3)).
Series known_sizes() {
  const double m = std::tgamma(16.0 / 3) / (std::tgamma(5) * std::cbrt(5));
  Series s{"V/<V> as 3125/24 v\u2074 exp(-5v)", Mark::dashed};
  for (int i = 0; i <= 100; ++i) {
    const double r = 0.02 * i, v = std::pow(m * r, 3);
    s.x.push_back(r);
    s.y.push_back(3125.0 / 24 * std::pow(v, 4) * std::exp(-5 * v) * 3 * m * m * m * r * r);
  }
  return s;
}

Figure figure_2(const Options& wanted) {
  const Options o = with_defaults(wanted, 100, 1000);
  const Gathered g = gather(o, {});
  const auto sizes = results::describe(g.sizes), faces = results::describe(g.faces);
  Plot a{.title = "grain size"};
  a.x = {.label = "R / mean R", .from = 0, .to = 2};
  a.y = {.label = "probability density", .from = 0, .to = 3.5};
  a.series = {curve_of(g.sizes, 0, 2, 50, "Voronoi, inner grains"),
              known_sizes(),
              {"cubes, truncated octahedra, rhombic dodecahedra", Mark::arrow, {1}, {}}};
  Plot b{.title = "faces per grain"};
  b.x = {.label = "faces per grain", .from = 0, .to = 40};
  b.y = {.label = "share of grains", .from = 0, .to = 0.15};
  b.series = {face_numbers(g.faces, "Voronoi, inner grains", Mark::bars),
              {"cubes: 6", Mark::arrow, {6}, {}},
              {"rhombic dodecahedra: 12", Mark::arrow, {12}, {}},
              {"truncated octahedra: 14", Mark::arrow, {14}, {}}};
  std::string text = counted(o, g);
  text += "| | paper | known | here |\n|---|---|---|---|\n";
  text += fmt::format(
      "| faces per inner grain | 15.1 | 15.05 at 1,000 grains, 15.5355 endless | "
      "{:.2f} (sd {:.2f}) |\n",
      faces.mean, faces.deviation);
  text +=
      fmt::format("| edges per inner grain | 39.1 | 40.606 endless | {:.1f} |\n", mean(g.edges));
  text += fmt::format("| R / mean R, standard deviation | - | 0.152 (dashed curve) | {:.3f} |\n",
                      sizes.deviation);
  return {"Grain sizes and faces of Poisson-Voronoi tessellations", {a, b}, text};
}

Figure figure_3(const Options& wanted) {
  const Options o = with_defaults(wanted, 100, 1000);
  const Gathered g = gather(o, {});
  Plot a{.title = "edge lengths"};
  a.x = {.label = "edge length (grains of unit mean volume)", .from = 0, .to = 2};
  a.y = {.label = "probability density", .from = 0};
  a.series = {steps_of(
      [&] {
        results::Histogram h(0, 2, 100);
        for (const double v : g.edge_lengths) h.add(v);
        return h;
      }(),
      "edges of inner grains")};
  Plot b{.title = "face diameters"};
  b.x = {.label = "face diameter (grains of unit mean volume)", .from = 0, .to = 2};
  b.y = {.label = "probability density", .from = 0};
  b.series = {steps_of(
      [&] {
        results::Histogram h(0, 2, 100);
        for (const double v : g.face_diameters) h.add(v);
        return h;
      }(),
      "faces of inner grains")};
  std::string text = counted(o, g);
  text += "| | known, endless | here |\n|---|---|---|\n";
  text += fmt::format("| mean edge length | 0.4309 | {:.4f} |\n", mean(g.edge_lengths));
  text += fmt::format("| edges below 0.13 (l_max) | - | {:.1f} % |\n",
                      100 * share_below(g.edge_lengths, 0.13));
  text += fmt::format("| mean face diameter | - | {:.3f} |\n", mean(g.face_diameters));
  text += fmt::format("| face diameters below 0.25 (c_l) | - | {:.1f} % |\n",
                      100 * share_below(g.face_diameters, 0.25));
  return {"Edge lengths and face diameters of Poisson-Voronoi tessellations", {a, b}, text};
}

Figure figure_5(const Options& wanted) {
  const Options o = with_defaults(wanted, 10, 1000);
  Plot a{.title = "edge lengths"}, b{.title = "face diameters"};
  a.x = {.label = "edge length (grains of unit mean volume)", .from = 0, .to = 1.5};
  b.x = {.label = "face diameter (grains of unit mean volume)", .from = 0, .to = 2};
  a.y = b.y = {.label = "probability density", .from = 0};
  std::string text, rows;
  for (const double fault : {0.0, 5.0, 10.0, 20.0, 30.0, 45.0}) {
    const Gathered g = gather(o, paper_regularisation(0.13, fault));
    mesh::RegularisationOptions default_rules;
    default_rules.max_flatness_fault = fault;
    const Gathered ours = gather(o, default_rules);
    if (text.empty()) text = counted(o, g);
    const std::string label = fmt::format("f_max {:g}\u00b0", fault);
    a.series.push_back(curve_of(g.edge_lengths, 0, 1.5, 75, label));
    b.series.push_back(curve_of(g.face_diameters, 0, 2, 80, label));
    rows += fmt::format("| {:g} | {:.2f} % | {:.2f} % | {:.2f} | {:.2f} % |\n", fault,
                        100 * share_below(g.edge_lengths, 0.13),
                        100 * share_below(g.face_diameters, 0.25), mean(g.faces),
                        100 * share_below(ours.edge_lengths, 0.13));
  }
  text +=
      "| f_max [degrees] | edges below l_max = 0.13 | face diameters below 0.25 | faces per inner "
      "grain | edges below l_max, ours (default) |\n|---|---|---|---|---|\n" +
      rows;
  return {"Regularisation at l_max 0.13 for growing f_max", {a, b}, text};
}

Figure figure_6(const Options& wanted) {
  const Options o = with_defaults(wanted, 20, 1000);
  const Gathered paper = gather(o, paper_regularisation(0.13));
  const Gathered ours = gather(o, mesh::RegularisationOptions{});
  Plot a{.title = "flatness faults"}, b{.title = "flatness faults, cumulative"};
  a.x = b.x = {.label = "flatness fault [degrees]", .from = 0, .to = 20};
  a.y = {.label = "share of faces per degree", .from = 1e-4, .to = 1, .logarithmic = true};
  b.y = {.label = "share of faces below", .from = 0, .to = 1};
  std::string text = fmt::format("{} x {} grains, all faces.\n\n", o.cubes, o.grains);
  text += "| | paper | the paper's rules | ours (default) |\n|---|---|---|---|\n";
  std::array<results::Distribution, 2> d;
  int i = 0;
  for (const auto* g : {&paper, &ours}) {
    const std::string label = i == 0 ? "the paper's rules" : "ours (default)";
    a.series.push_back(curve_of(g->faults, 0, 20, 40, label));
    results::Histogram h(0, 20, 80);
    for (const double f : g->faults) h.add(f);
    Series s{label, Mark::line, {}, h.cumulative()};
    for (int k = 0; k <= 80; ++k) s.x.push_back(h.edge(k));
    b.series.push_back(s);
    d[i++] = results::describe(g->faults);
  }
  b.series.push_back({"90 % below 6\u00b0 (paper)", Mark::points, {6}, {0.9}});
  text += fmt::format("| 90 % of the faults lie below | 6 | {:.1f} | {:.1f} |\n",
                      d[0].percentile(90), d[1].percentile(90));
  text += fmt::format("| share below 6 degrees | 90 % | {:.1f} % | {:.1f} % |\n",
                      100 * share_below(paper.faults, 6), 100 * share_below(ours.faults, 6));
  text += fmt::format("| mean | - | {:.2f} | {:.2f} |\n| largest | 20 | {:.2f} | {:.2f} |\n",
                      d[0].mean, d[1].mean, d[0].max, d[1].max);
  return {"Flatness faults after regularisation, f_max 20 degrees", {a, b}, text};
}

Figure figure_7(const Options& wanted) {
  const Options o = with_defaults(wanted, 10, 1000);
  const double lengths[] = {0, 0.13, 0.26, 0.39, 0.52}, paper[] = {15.1, 13.7, 12.3, 11.1, 10.2};
  Plot a{.title = "grain size"}, b{.title = "faces per grain"};
  a.x = {.label = "R / mean R", .from = 0, .to = 2};
  a.y = {.label = "probability density", .from = 0};
  b.x = {.label = "faces per grain", .from = 0, .to = 30};
  b.y = {.label = "share of grains", .from = 0};
  std::string text, rows;
  for (int i = 0; i < 5; ++i) {
    const Gathered g = gather(o, paper_regularisation(lengths[i]));
    const Gathered ours = gather(o, [&] {
      mesh::RegularisationOptions r;
      r.max_edge_length = lengths[i];
      return r;
    }());
    if (text.empty()) text = counted(o, g);
    const std::string label = fmt::format("l_max {:g}", lengths[i]);
    a.series.push_back(curve_of(ours.sizes, 0, 2, 40, label));
    b.series.push_back(face_numbers(ours.faces, label, Mark::line));
    rows += fmt::format("| {:g} | {} | {:.2f} | {:.2f} | {:.3f} |\n", lengths[i], paper[i],
                        mean(g.faces), mean(ours.faces), results::describe(ours.sizes).deviation);
  }
  text +=
      "| l_max | faces per inner grain, paper | the paper's rules | ours (default) | sd of R / "
      "mean "
      "R, ours |\n|---|---|---|---|---|\n" +
      rows;
  return {"Regularisation for growing l_max, f_max 20 degrees", {a, b}, text};
}

}  // namespace

mesh::RegularisationOptions paper_regularisation(double max_edge_length, double max_fault) {
  mesh::RegularisationOptions options;
  options.max_edge_length = max_edge_length;
  options.max_flatness_fault = max_fault;
  return options.as_in_the_paper();
}

Series curve_of(const results::Histogram& histogram, const std::string& label) {
  Series s{label, Mark::line, {}, histogram.density()};
  for (int i = 0; i < static_cast<int>(s.y.size()); ++i) s.x.push_back(histogram.centre(i));
  return s;
}

Series curve_of(const std::vector<double>& values, double from, double to, int bins,
                const std::string& label) {
  results::Histogram h(from, to, bins);
  for (const double v : values) h.add(v);
  return curve_of(h, label);
}

std::map<std::string, Maker> tessellation_figures() {
  return {{"2", figure_2}, {"3", figure_3}, {"5", figure_5}, {"6", figure_6}, {"7", figure_7}};
}

}  // namespace polyslip::figures
