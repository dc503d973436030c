// Whether remeshing changes the answer: `remeshing_accuracy OFTEN SELDOM NEVER OTHER EARLY END
// FIGURE PAGE`: four run folders of one polycrystal, compared with NEVER at the strain EARLY and
// with each other at END. scripts/remeshing-accuracy makes them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <sstream>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "core/tensor.hpp"
#include "remap/grain_statistics.hpp"
#include "remap/wear.hpp"
#include "results/names.hpp"
#include "results/plot.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace {

using namespace polyslip;
using Grains = std::vector<remap::GrainStatistics>;

struct Curve {
  std::vector<double> strain, stress;  // von Mises, MPa
};

struct Run {
  std::string folder;
  results::StateSeries states;
  Curve curve;
  explicit Run(const std::string& path);
};

/// Columns strain and sxx ... sxy of macro.csv.
Curve read_curve(const std::string& folder) {
  std::istringstream text(core::read_text(results::in_folder(folder, results::macro_name)));
  Curve curve;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    if (v.size() < 9) throw core::InputError(folder + ": macro.csv is damaged");
    core::Mat3 s;
    s << v[3], v[8], v[7], v[8], v[4], v[6], v[7], v[6], v[5];
    curve.strain.push_back(v[0]);
    curve.stress.push_back(core::equivalent_stress(s));
  }
  if (curve.strain.empty()) throw core::InputError(folder + ": macro.csv has no steps");
  return curve;
}

Run::Run(const std::string& path) : folder(path), states(path), curve(read_curve(path)) {}

/// At the step that ends there, before a remeshing.
double stress_at(const Run& run, double strain) {
  for (std::size_t i = 0; i < run.curve.strain.size(); ++i)
    if (std::abs(run.curve.strain[i] - strain) < 1e-9) return run.curve.stress[i];
  throw core::InputError(fmt::format("{}: no step ends at {}", run.folder, strain));
}

Grains grains_at(const Run& run, double strain) {
  const auto& state = results::nearest_state(run.states, strain);
  if (std::abs(state.strain - strain) > 1e-9)
    throw core::InputError(fmt::format("{}: no state at {}", run.folder, strain));
  return remap::grain_statistics(results::read_state(run.states.path(state)), 2);
}

/// Between two runs at a strain.
struct Difference {
  double rotation = 0, worst_rotation = 0;  // of grains' mean orientations [degrees]
  double spread = 0;                        // of the mean over the grains, relative
  double spread_rms = 0;                    // over the grains, relative to the mean
  double stress = 0;                        // relative
};

Difference difference(const Run& a, const Run& b, double strain) {
  const Grains p = grains_at(a, strain), q = grains_at(b, strain);
  if (p.size() != q.size()) throw core::InputError("the runs have different grains");
  Difference d;
  double first = 0, second = 0, squares = 0;
  for (std::size_t g = 0; g < p.size(); ++g) {
    const double angle =
        core::degrees_per_radian * core::disorientation_angle(p[g].orientation, q[g].orientation);
    d.rotation += angle / static_cast<double>(p.size());
    d.worst_rotation = std::max(d.worst_rotation, angle);
    first += p[g].spread;
    second += q[g].spread;
    squares += std::pow(p[g].spread - q[g].spread, 2);
  }
  d.spread = first / second - 1;
  d.spread_rms = std::sqrt(squares * static_cast<double>(p.size())) / second;
  d.stress = stress_at(a, strain) / stress_at(b, strain) - 1;
  return d;
}

std::string row(const std::string& what, double strain, const Difference& d) {
  return fmt::format("| {} | {:g} | {:.2f} | {:.2f} | {:+.1f} % | {:.1f} % | {:+.2f} % |\n", what,
                     strain, d.rotation, d.worst_rotation, 100 * d.spread, 100 * d.spread_rms,
                     100 * d.stress);
}

/// The first stored strain at which a corner or point of an element has turned over.
std::string first_inversion(const Run& run) {
  double last = 0;
  for (const auto& state : run.states.states()) {
    const auto s = results::read_state(run.states.path(state));
    const auto frame = remap::isotropy_frame(remap::initial_positions(s), s.mesh.nodes);
    if (remap::measure_wear(s.mesh.tetrahedra, s.mesh.nodes, {}, frame, {}, 2).worst_jacobian <= 0)
      return fmt::format("first between {:g} and {:g}", last, state.strain);
    last = state.strain;
  }
  return fmt::format("first beyond {:g}", last);
}

results::Series spreads(const Run& run, double strain, const std::string& label) {
  results::Histogram histogram(0, 20, 20);
  for (const auto& g : grains_at(run, strain)) histogram.add(g.spread);
  return results::steps_of(histogram, label);
}

void draw(const std::string& path, const Run& often, const Run& seldom, const Run& never,
          const Run& other, double end) {
  results::Plot curves{
      .title = "Stress", .x = {.label = "strain"}, .y = {.label = "von Mises stress, MPa"}};
  for (const auto& [run, label] :
       {std::pair{&often, "often"}, {&seldom, "seldom"}, {&never, "never"}, {&other, "other mesh"}})
    curves.series.push_back({.label = label, .x = run->curve.strain, .y = run->curve.stress});
  results::Plot densities{.title = fmt::format("Spreads within grains at {:g}", end),
                          .x = {.label = "spread, degrees"},
                          .y = {.label = "density, 1/degree"}};
  densities.series = {spreads(often, end, "often"), spreads(seldom, end, "seldom"),
                      spreads(other, end, "other mesh")};
  results::write_svg(path, {curves, densities}, "What remeshing changes");
}

/// Replaces what stands between the page's marks.
void renew_page(const std::string& page, const std::string& numbers) {
  const std::string begin = "<!-- numbers -->\n", end = "<!-- end -->";
  std::string text = core::read_text(page);
  const auto from = text.find(begin), to = text.find(end);
  if (from == std::string::npos || to == std::string::npos)
    throw core::InputError(page + ": has no marks for the numbers");
  text.replace(from + begin.size(), to - from - begin.size(), numbers);
  core::write_file(page, text);
}

std::string numbers(const Run& often, const Run& seldom, const Run& never, const Run& other,
                    double early, double end) {
  const auto first = results::read_state(often.states.path(often.states.states().front()));
  std::string text = fmt::format(
      "{} grains, {} elements at the start; of the mesh that is never replaced an element "
      "inverts {}.\n\n| | strain | mean rotation | worst | mean spread | spreads, rms | stress |\n"
      "|---|---|---|---|---|---|---|\n",
      first.mesh.topology.cell_count(), first.mesh.element_count(), first_inversion(never));
  text += row("often against seldom", end, difference(often, seldom, end));
  text += row("often against never", early, difference(often, never, early));
  text += row("seldom against another first mesh", end, difference(seldom, other, end));
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() != 8) {
    fmt::print(stderr,
               "usage: remeshing_accuracy OFTEN SELDOM NEVER OTHER EARLY END FIGURE PAGE\n");
    return 2;
  }
  try {
    const Run often(arguments[0]), seldom(arguments[1]), never(arguments[2]), other(arguments[3]);
    const double early = std::stod(arguments[4]), end = std::stod(arguments[5]);
    const auto text = numbers(often, seldom, never, other, early, end);
    fmt::print("{}", text);
    draw(arguments[6], often, seldom, never, other, end);
    renew_page(arguments[7], text);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
