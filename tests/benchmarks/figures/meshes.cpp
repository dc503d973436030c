// Figures 8 to 11: what regularisation and multimeshing do to the mesh.

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include "figures.hpp"
#include "mesh/geometry.hpp"
#include "mesh/measures.hpp"

namespace polyslip::figures {
namespace {

using results::Mark;
using results::Plot;
using results::Series;

/// A way to make a mesh of a tessellation.
struct Strategy {
  std::string label;
  bool regularised = true;
  double progression = 1.5;            ///< p_l
  std::vector<std::string> meshers{};  ///< empty: the default
  bool paper = false;                  ///< the paper's chain: nothing of ours afterwards
};

/// Elements and grains of the inner grains of all meshes of one strategy.
struct Gathered {
  std::string label;
  long grains = 0, elements = 0, all_elements = 0;
  std::vector<float> ratios, sizes;  ///< sizes relative to c_l
  std::vector<double> O, worst;

  double per_million(double bound) const {
    long n = 0;
    for (const float r : ratios) n += r < bound;
    return 1e6 * static_cast<double>(n) / static_cast<double>(ratios.size());
  }
};

void add(Gathered& g, const mesh::Mesh& mesh, double element_size) {
  const mesh::Measures m = mesh::measure(mesh);
  const auto grains = mesh::measure_grain_meshes(mesh, element_size);
  g.all_elements += mesh.element_count();
  for (std::size_t c = 0; c < grains.size(); ++c) {
    if (!m.grains[c].inner) continue;
    ++g.grains;
    g.O.push_back(grains[c].O);
    g.worst.push_back(grains[c].min_radius_ratio);
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!m.grains[mesh.tetrahedron_cell[e]].inner) continue;
    const mesh::ElementMeasures element = mesh::measure_element(mesh, e);
    ++g.elements;
    g.ratios.push_back(static_cast<float>(element.radius_ratio));
    g.sizes.push_back(static_cast<float>(element.size / element_size));
  }
}

mesh::MeshingOptions meshing_options(const Options& o, const Strategy& strategy) {
  mesh::MeshingOptions meshing;
  meshing.element_size = o.element_size;
  meshing.progression_factor = strategy.progression;
  meshing.jobs = o.jobs;
  if (!strategy.meshers.empty()) meshing.meshers = strategy.meshers;
  if (strategy.paper) {
    meshing.slide_boundary = false;
    meshing.mesher_target = 1;  // each mesher tries each grain
  }
  return meshing;
}

std::vector<Gathered> gather(const Options& o, const std::vector<Strategy>& strategies) {
  const auto pool = mesh::MesherPool::start(o.worker);
  std::vector<Gathered> all;
  for (const Strategy& strategy : strategies) {
    Gathered g;
    g.label = strategy.label;
    for (int cube = 0; cube < o.cubes; ++cube) {
      mesh::PolycrystalOptions polycrystal;
      polycrystal.grains = o.grains;
      polycrystal.seed = o.seed + static_cast<std::uint64_t>(cube);
      mesh::Tessellation tessellation = mesh::voronoi_tessellation(polycrystal);
      if (strategy.regularised) mesh::regularise(tessellation, {});
      mesh::MeshingReport report;
      add(g,
          mesh::mesh_geometry(mesh::geometry_of(tessellation), meshing_options(o, strategy),
                              core::Vec3::Ones(), *pool, report),
          o.element_size);
    }
    all.push_back(std::move(g));
  }
  return all;
}

Options with_defaults(Options options, int cubes, int grains) {
  if (options.cubes == 0) options.cubes = cubes;
  if (options.grains == 0) options.grains = grains;
  return options;
}

template <class Number>
Series curve(const std::vector<Number>& values, double to, int bins, const std::string& label) {
  results::Histogram h(0, to, bins);
  for (const Number v : values) h.add(static_cast<double>(v));
  return curve_of(h, label);
}

std::string counted(const Options& o, const std::vector<Gathered>& all) {
  return fmt::format("{} x {} grains, {} of them inner; c_l = {:g}; inner grains are counted.\n\n",
                     o.cubes, o.grains, all.front().grains, o.element_size);
}

/// (a, b) radius ratios and (c, d) relative element sizes, linear and logarithmic.
std::vector<Plot> element_panels(const std::vector<Gathered>& all) {
  std::vector<Plot> panels(4);
  panels[0].title = "element quality";
  panels[1].title = "element quality, logarithmic";
  panels[2].title = "element size";
  panels[3].title = "element size, logarithmic";
  for (int i = 0; i < 4; ++i) {
    panels[i].x = i < 2 ? results::PlotAxis{.label = "radius ratio", .from = 0, .to = 1}
                        : results::PlotAxis{.label = "element size / c_l", .from = 0, .to = 2};
    panels[i].y.label = "probability density";
    if (i % 2 == 1) panels[i].y.from = 1e-5;
    if (i % 2 == 1) panels[i].y.logarithmic = true;
  }
  for (const Gathered& g : all)
    for (int i = 0; i < 4; ++i)
      panels[i].series.push_back(i < 2 ? curve(g.ratios, 1, 50, g.label)
                                       : curve(g.sizes, 2, 50, g.label));
  return panels;
}

std::string quality_table(const std::vector<Gathered>& all) {
  std::string text =
      "| mesh | elements per grain | mean radius ratio | worst | below 0.01 per million | below "
      "0.05 | below 0.1 | mean worst of a grain | mean element size / c_l | mean O |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Gathered& g : all) {
    const auto ratios = results::describe(g.ratios);
    fmt::format_to(
        std::back_inserter(text),
        "| {} | {:.0f} | {:.3f} | {:.4f} | {:.1f} | {:.1f} | {:.1f} | {:.3f} | {:.3f} | {:.3f} |\n",
        g.label, static_cast<double>(g.elements) / static_cast<double>(g.grains), ratios.mean,
        ratios.min, g.per_million(0.01), g.per_million(0.05), g.per_million(0.1),
        results::describe(g.worst).mean, results::describe(g.sizes).mean,
        results::describe(g.O).mean);
  }
  return text;
}

std::vector<Strategy> regularisation_strategies() {
  return {{.label = "Voronoi, p_l = 1000", .regularised = false, .progression = 1000},
          {.label = "Voronoi, p_l = 1.5", .regularised = false},
          {.label = "regularised, p_l = 1.5"}};
}

/// A wire frame of the mesh on the domain face z1, and the edges of the grains there.
Plot picture(const mesh::Mesh& mesh, const std::string& title) {
  constexpr int top = 5;  // z1
  Plot plot{.title = title};
  plot.x = {.label = "x (grains of unit mean volume)", .from = 0, .to = mesh.size[0]};
  plot.y = {.label = "y", .from = 0, .to = mesh.size[1]};
  const double gap = std::nan("");
  const auto draw = [&](Series& s, int a, int b) {
    for (const int n : {a, b}) {
      s.x.push_back(mesh.nodes[n].x());
      s.y.push_back(mesh.nodes[n].y());
    }
    s.x.push_back(gap);
    s.y.push_back(gap);
  };
  Series wires{"", Mark::fine}, grains{"grain boundaries", Mark::line};
  std::set<std::pair<int, int>> drawn;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.topology.faces[mesh.triangle_face[i]].domain_face != top) continue;
    const auto& t = mesh.triangles[i];
    for (const auto& [p, q] : mesh::triangle_edges)
      if (drawn.insert(std::minmax(t[p], t[q])).second) draw(wires, t[p], t[q]);
  }
  for (const auto& line : mesh.lines)
    if (drawn.contains(std::minmax(line[0], line[1]))) draw(grains, line[0], line[1]);
  plot.series = {wires, grains};
  return plot;
}

/// A box as wide to its height as a panel, so that the picture is not distorted.
Figure figure_8(const Options& wanted) {
  const Options o = with_defaults(wanted, 1, 60);
  const auto pool = mesh::MesherPool::start(o.worker);
  mesh::PolycrystalOptions polycrystal;
  polycrystal.grains = o.grains;
  polycrystal.seed = o.seed;
  polycrystal.domain = {1.43, 1, 0.7};
  const auto raw = mesh::voronoi_tessellation(polycrystal);
  Figure figure{"The mesh with and without regularisation", {}, {}};
  Plot bars{.title = "elements per grain"};
  bars.x = {.label = "panel: 1 (a), 2 (b), 3 (c)", .from = 0, .to = 4};
  bars.y = {.label = "elements per grain", .from = 0};
  figure.text = fmt::format("{} grains in a box of 1.43 : 1 : 0.7, all counted; c_l = {:g}.\n\n",
                            o.grains, o.element_size);
  figure.text += "| mesh | elements per grain | worst radius ratio |\n|---|---|---|\n";
  for (const Strategy& strategy : regularisation_strategies()) {
    mesh::Tessellation tessellation = raw;
    if (strategy.regularised) mesh::regularise(tessellation, {});
    mesh::MeshingReport report;
    const auto mesh =
        mesh::mesh_geometry(mesh::geometry_of(tessellation), meshing_options(o, strategy),
                            core::Vec3::Ones(), *pool, report);
    const double each = static_cast<double>(mesh.element_count()) / o.grains;
    figure.panels.push_back(picture(mesh, strategy.label));
    bars.series.push_back(
        {strategy.label, Mark::bars, {static_cast<double>(figure.panels.size())}, {each}});
    figure.text += fmt::format("| {} | {:.0f} | {:.4f} |\n", strategy.label, each,
                               mesh::quality(mesh).min_radius_ratio);
  }
  figure.panels.push_back(bars);
  return figure;
}

Figure figure_9(const Options& wanted) {
  const Options o = with_defaults(wanted, 1, 500);
  const auto all = gather(o, regularisation_strategies());
  return {"Element quality and size with and without regularisation", element_panels(all),
          counted(o, all) + quality_table(all)};
}

std::vector<Strategy> multimeshing_strategies() {
  return {{.label = "mesher 1", .meshers = {"paper-1"}, .paper = true},
          {.label = "mesher 2", .meshers = {"paper-2"}, .paper = true},
          {.label = "multimeshing, 1 and 2", .meshers = {"paper-1", "paper-2"}, .paper = true},
          {.label = "ours (default)"}};
}

Figure figure_10(const Options& o, const std::vector<Gathered>& all) {
  Plot a{.title = "O of the grains"}, b{.title = "O of the grains, logarithmic"};
  a.x = {.label = "O", .from = 0.5, .to = 1};
  b.x = {.label = "O", .from = 0, .to = 1};
  a.y.label = b.y.label = "probability density";
  b.y.logarithmic = true;
  for (const Gathered& g : all) {
    results::Histogram h(0.5, 1, 25);
    for (const double O : g.O) h.add(O);
    a.series.push_back(curve_of(h, g.label));
    b.series.push_back(curve(g.O, 1, 20, g.label));
  }
  return {"O of single meshers and of multimeshing", {a, b}, counted(o, all) + quality_table(all)};
}

Figure figure_11(const Options& o, const std::vector<Gathered>& all) {
  return {"Element quality and size of single meshers and of multimeshing", element_panels(all),
          counted(o, all) + quality_table(all)};
}

}  // namespace

std::map<std::string, Maker> mesh_figures() {
  // Figures 10 and 11 show the same meshes: made once if both are asked for.
  const auto meshes = std::make_shared<std::vector<Gathered>>();
  const auto of_meshes = [meshes](auto draw) {
    return [meshes, draw](const Options& wanted) {
      const Options o = with_defaults(wanted, 1, 500);
      if (meshes->empty()) *meshes = gather(o, multimeshing_strategies());
      return draw(o, *meshes);
    };
  };
  return {
      {"8", figure_8}, {"9", figure_9}, {"10", of_meshes(figure_10)}, {"11", of_meshes(figure_11)}};
}

}  // namespace polyslip::figures
