#include "results/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "mesh/quality_criterion.hpp"

namespace polyslip::results {
namespace {

using mesh::FaceMeasures;
using mesh::GrainMeasures;
using mesh::GrainMeshMeasures;

/// What a quantity is, and the bins of its histogram; `last` 0: a round number above the largest.
struct Kind {
  std::string key, label, unit, definition;
  double last = 0;
  bool whole_numbers = false;
};

const Kind grain_volume{"grain_volume", "grain volume", "L^3", "Volume of a grain."};
const Kind grain_diameter{
    "grain_relative_diameter", "grain size, R / mean R", "1",
    "Radius of the sphere of a grain's volume, relative to its mean over the grains counted.", 2};
const Kind grain_sphericity{
    "grain_sphericity", "sphericity", "1",
    "Area of the sphere of a grain's volume over the area of the grain's surface.", 1};
const Kind grain_faces{
    "grain_faces", "faces per grain", "1", "Faces of a grain, those on the domain boundary too.", 0,
    true};
const Kind grain_edges{"grain_edges", "edges per grain", "1", "Edges of a grain.", 0, true};
const Kind grain_vertices{
    "grain_vertices", "vertices per grain", "1", "Vertices of a grain.", 0, true};
const Kind grain_neighbours{"grain_neighbours",
                            "neighbours per grain",
                            "1",
                            "Other grains that share a face with a grain.",
                            0,
                            true};
const Kind face_diameter{"face_diameter", "face diameter", "L",
                         "Diameter of the circle of a face's area."};
const Kind face_edges{"face_edges", "edges per face", "1", "Edges of a face.", 0, true};
const Kind face_fault{"face_flatness_fault", "flatness fault", "degrees",
                      "Largest angle between the normals of two triangles of a face.", 20};
const Kind face_corner{"face_least_corner", "least corner of a face", "degrees",
                       "Least angle between two edges of a face that follow each other.", 180};
const Kind edge_length{"edge_length", "edge length", "L", "Length of an edge."};
const Kind element_ratio{"radius_ratio", "radius ratio", "1",
                         "3 r_in / R_circ of the tetrahedron through an element's corners.", 1};
const Kind element_length{"element_size", "element size", "L",
                          "Mean length of an element's six straight edges."};
const Kind element_relative{"relative_element_size", "element size / c_l", "1",
                            "Element size over c_l, the size that was asked for in its grain.", 2};
const Kind mesh_elements{
    "grain_elements", "elements per grain", "1", "Elements of a grain.", 0, true};
const Kind mesh_worst{"grain_min_radius_ratio", "worst radius ratio of a grain", "1",
                      "Least radius ratio of a grain's elements.", 1};
const Kind mesh_O{"grain_O", "O per grain", "1", "Mesh quality of a grain, eq. (5).", 1};
const Kind mesh_O_dis{"grain_O_dis", "O_dis per grain", "1",
                      "Its part from the radius ratios, eq. (6).", 1};
const Kind mesh_O_size{"grain_O_size", "O_size per grain", "1",
                       "Its part from the element sizes, eq. (7).", 1};

/// 1, 1.5, 2, 3, 5 or 7 times a power of ten, not below `value`.
double round_up(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
    if (value <= factor * power) return factor * power;
  return 10 * power;
}

Histogram bins_of(const Kind& kind, double largest) {
  if (kind.whole_numbers) {
    // Each number in the middle of a bin, up to 120 bins; then several to a bin.
    const auto n = static_cast<long>(std::isfinite(largest) ? largest : 0) + 1;
    const long each = (n + 119) / 120;
    const auto bins = static_cast<int>((n + each - 1) / each);
    return {-0.5, -0.5 + static_cast<double>(bins * each), bins};
  }
  return {0, kind.last > 0 ? kind.last : round_up(largest), 50};
}

template <class Number>
Quantity make(const Kind& kind, std::vector<Number> values) {
  Quantity q{kind.key,           kind.label, kind.unit, kind.definition,
             kind.whole_numbers, {},         {0, 1, 1}, {}};
  Number largest = 0;
  for (const Number v : values)
    if (std::isfinite(v)) largest = std::max(largest, v);
  q.histogram = bins_of(kind, static_cast<double>(largest));
  for (const Number v : values) q.histogram.add(static_cast<double>(v));
  q.distribution = describe(std::move(values));
  return q;
}

template <class Value>
std::vector<double> of_grains(const Statistics& s, Value value) {
  std::vector<double> values;
  for (const GrainMeasures& grain : s.measures.grains)
    if (!s.options.inner || grain.inner) values.push_back(static_cast<double>(value(grain)));
  return values;
}

/// Of faces or edges.
template <class Entity, class Value>
std::vector<double> collect(const Statistics& s, const std::vector<Entity>& all, Value value) {
  std::vector<double> values;
  for (const Entity& one : all)
    if (s.counts(one)) values.push_back(static_cast<double>(value(one)));
  return values;
}

void add_polycrystal(Statistics& s) {
  const auto grains = [&](const Kind& kind, auto value) {
    s.quantities.push_back(make(kind, of_grains(s, value)));
  };
  const auto faces = [&](const Kind& kind, auto value) {
    s.quantities.push_back(make(kind, collect(s, s.measures.faces, value)));
  };
  grains(grain_volume, [](const GrainMeasures& g) { return g.volume; });
  std::vector<double> diameters = of_grains(s, [](const GrainMeasures& g) { return g.diameter(); });
  const double mean = describe(diameters).mean;
  for (double& d : diameters) d /= mean;
  s.quantities.push_back(make(grain_diameter, std::move(diameters)));
  grains(grain_sphericity, [](const GrainMeasures& g) { return g.sphericity(); });
  grains(grain_faces, [](const GrainMeasures& g) { return g.faces; });
  grains(grain_edges, [](const GrainMeasures& g) { return g.edges; });
  grains(grain_vertices, [](const GrainMeasures& g) { return g.vertices; });
  grains(grain_neighbours, [](const GrainMeasures& g) { return g.neighbours; });
  faces(face_diameter, [](const FaceMeasures& f) { return f.diameter(); });
  faces(face_edges, [](const FaceMeasures& f) { return f.edges; });
  faces(face_fault, [](const FaceMeasures& f) { return f.flatness_fault; });
  faces(face_corner, [](const FaceMeasures& f) { return f.least_corner; });
  s.quantities.push_back(
      make(edge_length, collect(s, s.measures.edges, [](const auto& e) { return e.length; })));
}

/// Elements of the grains that count; single precision: they may be tens of millions.
template <class Value>
std::vector<float> elements(const Statistics& s, const mesh::Mesh& mesh, Value value) {
  std::vector<float> values;
  values.reserve(mesh.tetrahedra.size());
  for (int e = 0; e < mesh.element_count(); ++e)
    if (s.counts(mesh.tetrahedron_cell[e]))
      values.push_back(static_cast<float>(value(mesh::measure_element(mesh, e))));
  return values;
}

void add_elements(Statistics& s, const mesh::Mesh& mesh) {
  auto ratios = elements(s, mesh, [](const auto& e) { return e.radius_ratio; });
  std::vector<std::pair<double, long>> below;
  for (const double bound : {0.01, 0.05, 0.1, 0.2, 0.3})
    below.emplace_back(
        bound, std::count_if(ratios.begin(), ratios.end(), [&](float r) { return r < bound; }));
  s.quantities.push_back(make(element_ratio, std::move(ratios)));
  s.quantities.back().counts_below = std::move(below);
  auto sizes = elements(s, mesh, [](const auto& e) { return e.size; });
  s.quantities.push_back(make(element_length, sizes));
  if (!s.options.element_size) {
    s.options.element_size = s.quantities.back().distribution.mean;
    s.options.element_size_source = ElementSizeSource::mean;
  }
  std::size_t i = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int grain = mesh.tetrahedron_cell[e];
    if (!s.counts(grain)) continue;
    sizes[i] = static_cast<float>(sizes[i] / s.element_size(grain));
    ++i;
  }
  s.quantities.push_back(make(element_relative, std::move(sizes)));
}

void add_grain_meshes(Statistics& s, const mesh::Mesh& mesh) {
  std::vector<double> wanted(s.measures.grains.size());
  for (std::size_t c = 0; c < wanted.size(); ++c) wanted[c] = s.element_size(static_cast<int>(c));
  s.grain_meshes = mesh::measure_grain_meshes(mesh, wanted);
  const auto add = [&](const Kind& kind, auto value) {
    std::vector<double> values;
    for (std::size_t c = 0; c < s.grain_meshes.size(); ++c)
      if (s.counts(static_cast<int>(c))) values.push_back(value(s.grain_meshes[c]));
    s.quantities.push_back(make(kind, std::move(values)));
  };
  add(mesh_elements, [](const GrainMeshMeasures& g) { return g.elements; });
  add(mesh_worst, [](const GrainMeshMeasures& g) { return g.min_radius_ratio; });
  add(mesh_O, [](const GrainMeshMeasures& g) { return g.O; });
  add(mesh_O_dis, [](const GrainMeshMeasures& g) { return g.O_dis; });
  add(mesh_O_size, [](const GrainMeshMeasures& g) { return g.O_size; });
  mesh::QualityCriterion all(*s.options.element_size);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int grain = mesh.tetrahedron_cell[e];
    if (!s.counts(grain)) continue;
    const mesh::ElementMeasures m = mesh::measure_element(mesh, e);
    all.add(m.radius_ratio, m.size, s.element_size(grain));
  }
  s.O_dis = all.distortion();
  s.O_size = all.size();
  s.O = all.value();
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("-");
}

}  // namespace

std::string text_of(ElementSizeSource source) {
  switch (source) {
    case ElementSizeSource::deck:
      return "the deck";
    case ElementSizeSource::option:
      return "--element-size";
    case ElementSizeSource::mean:
      return "the mean element (give --element-size to set it)";
    case ElementSizeSource::none:
      break;
  }
  return "nothing";
}

std::string Statistics::domain_face_name(int face) const {
  if (face < 0) return "";
  return face < static_cast<int>(domain_faces.size()) ? domain_faces[face]
                                                      : std::to_string(face + 1);
}

const Quantity& Statistics::quantity(const std::string& key) const {
  for (const Quantity& q : quantities)
    if (q.key == key) return q;
  throw core::InternalError("results/statistics: no quantity " + key);
}

Statistics statistics_of(mesh::Measures measures, const mesh::Mesh* mesh,
                         const StatisticsOptions& options) {
  Statistics s;
  s.options = options;
  s.measures = std::move(measures);
  s.grains = static_cast<int>(s.measures.grains.size());
  s.inner_grains =
      static_cast<int>(std::count_if(s.measures.grains.begin(), s.measures.grains.end(),
                                     [](const GrainMeasures& g) { return g.inner; }));
  if (options.inner && s.inner_grains == 0)
    throw core::InputError(fmt::format(
        "--inner: each of the {} grains has a face on the domain boundary; leave it out",
        s.grains));
  const auto once = [](const auto& all) {
    return static_cast<int>(
        std::count_if(all.begin(), all.end(), [](const auto& one) { return !one.is_translate; }));
  };
  s.faces = once(s.measures.faces);
  s.edges = once(s.measures.edges);
  s.vertices = s.measures.vertices;
  add_polycrystal(s);
  if (mesh != nullptr) {
    s.elements = mesh->element_count();
    s.nodes = mesh->node_count();
    add_elements(s, *mesh);
    add_grain_meshes(s, *mesh);
  }
  return s;
}

std::string table_text(const Statistics& s, const std::string& source) {
  std::string text = fmt::format("{}: {} grains ({} inner), {} faces, {} edges, {} vertices",
                                 source, s.grains, s.inner_grains, s.faces, s.edges, s.vertices);
  if (s.elements > 0) text += fmt::format("; {} elements, {} nodes", s.elements, s.nodes);
  text += fmt::format(
      "\nlengths for grains of unit mean volume; {}\n",
      s.options.inner ? "inner grains only, their faces, edges and elements" : "all grains");
  text += fmt::format("\n{:<31}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "count",
                      "mean", "sd", "min", "p10", "median", "p90", "max");
  for (const Quantity& q : s.quantities) {
    const Distribution& d = q.distribution;
    std::string label = q.label;
    if (q.unit == "degrees") label += " [degrees]";
    text +=
        fmt::format("{:<31}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", label, d.count,
                    number(d.mean), number(d.deviation), number(d.min), number(d.percentile(10)),
                    number(d.percentile(50)), number(d.percentile(90)), number(d.max));
  }
  if (const auto& r = s.regularisation; r && r->worst_grain > 0)
    text += fmt::format(
        "\nregularisation changed the grains' volumes by {:.2g} % rms, grain {}'s by {:+.2g} %\n",
        100 * r->volume_change_rms, r->worst_grain, 100 * r->volume_change_worst);
  if (s.elements == 0) return text;
  text += "\nradius ratios below";
  for (const auto& [bound, count] : s.quantity("radius_ratio").counts_below)
    text += fmt::format("  {:g}: {}", bound, count);
  text += fmt::format(
      "\nc_l = {:.4g}{}, from {}; over all elements O_dis {:.4g}, O_size {:.4g}, O "
      "{:.4g}\n",
      *s.options.element_size, s.options.element_sizes.empty() ? "" : " (some grains their own)",
      text_of(s.options.element_size_source), s.O_dis, s.O_size, s.O);
  return text;
}

std::string json_text(const Statistics& s, const std::string& source) {
  using Json = nlohmann::ordered_json;
  Json j = {{"schema", "polyslip-stats/1"},
            {"source", source},
            {"length_unit", "edge of the cube of the mean grain's volume"},
            {"inner_grains_only", s.options.inner},
            {"grains", s.grains},
            {"inner_grains", s.inner_grains},
            {"faces", s.faces},
            {"edges", s.edges},
            {"vertices", s.vertices}};
  if (s.elements > 0) {
    j["elements"] = s.elements;
    j["nodes"] = s.nodes;
    j["element_size_asked"] = *s.options.element_size;
    j["element_size_asked_from"] = text_of(s.options.element_size_source);
    j["O_over_all_elements"] = {{"O_dis", s.O_dis}, {"O_size", s.O_size}, {"O", s.O}};
  }
  if (s.regularisation) j["regularisation"] = to_json(*s.regularisation);
  for (const Quantity& q : s.quantities) {
    const Distribution& d = q.distribution;
    Json one = {{"label", q.label},
                {"unit", q.unit},
                {"definition", q.definition},
                {"count", d.count},
                {"undefined", d.undefined},
                {"mean", d.mean},
                {"standard_deviation", d.deviation},
                {"min", d.min},
                {"max", d.max}};
    for (std::size_t i = 0; i < percentile_ranks.size(); ++i)
      one["percentiles"][std::to_string(percentile_ranks[i])] = d.percentiles[i];
    for (const auto& [bound, count] : q.counts_below)
      one["counts_below"][fmt::format("{:g}", bound)] = count;
    one["histogram"] = {{"from", q.histogram.from},
                        {"width", q.histogram.width},
                        {"counts", q.histogram.counts},
                        {"below", q.histogram.below},
                        {"above", q.histogram.above}};
    j["quantities"][q.key] = one;
  }
  return j.dump(1) + "\n";
}

}  // namespace polyslip::results
