#include "solver/body_state.hpp"

#include <algorithm>

#include "solver/exchange.hpp"
#include "solver/snapshot_fields.hpp"

namespace polyslip::solver {
namespace {

using core::Transport;
using mesh::Location;

std::vector<double> flat(const std::vector<core::Vec3>& points) {
  std::vector<double> out;
  out.reserve(3 * points.size());
  for (const auto& p : points) out.insert(out.end(), {p[0], p[1], p[2]});
  return out;
}

/// The law's state, field by field, out of its blocks.
void add_state_fields(const BodyState& body, const BodyLayout& layout,
                      std::vector<FieldPart>& parts) {
  const PointRule& rule = layout.rule;
  const int size = layout.law.layout().size();
  int offset = 0;
  for (const auto& part : layout.law.layout().fields) {
    const int components = part.components;
    const auto append = [&state = body.now.state, &rule, size, offset, components](
                            std::size_t first, std::size_t last, std::vector<double>& out) {
      append_state(rule, size, offset, components, state, first, last, out);
    };
    FieldPart field;
    field.outline.name = part.name;
    field.outline.location = Location::quadrature_point;
    field.outline.components = components;
    field.outline.unit = part.unit;
    field.outline.transport = part.transport;
    field.outline.description = part.description;
    field.each = static_cast<std::size_t>(rule.points * components);
    field.append = append;
    parts.push_back(std::move(field));
    offset += components;
  }
}

std::vector<double> read_state(const Distribution& distribution, const mesh::Snapshot& snapshot,
                               const BodyLayout& layout) {
  const int size = layout.law.layout().size();
  std::vector<double> blocks(distribution.local().elements.size() *
                             static_cast<std::size_t>(size * layout.rule.slots));
  int offset = 0;
  for (const auto& part : layout.law.layout().fields) {
    fill_state(layout.rule, size, offset, part.components,
               scatter_field(distribution, snapshot, part.name, Location::quadrature_point,
                             part.components),
               blocks);
    offset += part.components;
  }
  return blocks;
}

}  // namespace

std::vector<double> scatter_field(const Distribution& distribution, const mesh::Snapshot& snapshot,
                                  const std::string& name, Location location, int components) {
  const MPI_Comm comm = distribution.local().comm;
  const bool root = rank_of(comm) == 0;
  const auto values = root ? values_of(snapshot, name, location) : std::vector<double>{};
  if (!broadcast(comm, !values.empty())) return {};
  const int points =
      location == Location::quadrature_point ? broadcast(comm, snapshot.quadrature_points) : 1;
  return location == Location::node ? distribution.scatter_nodes(values, components)
                                    : distribution.scatter_elements(values, components * points);
}

BodyState read_body(const Distribution& distribution, const mesh::Snapshot& snapshot,
                    const BodyLayout& layout) {
  const LocalMesh& local = distribution.local();
  const bool root = rank_of(local.comm) == 0;
  const PointRule& rule = layout.rule;
  const std::size_t elements = local.elements.size();
  const std::size_t points = elements * static_cast<std::size_t>(rule.points);
  BodyState body;
  body.now.x =
      distribution.scatter_nodes(root ? flat(snapshot.mesh.nodes) : std::vector<double>{}, 3);
  body.now.state = read_state(distribution, snapshot, layout);
  // Without the volumes of zero stress there is no pressure: a fresh or remeshed body.
  const bool stressed =
      broadcast(local.comm, snapshot.find(field::reference_volume, Location::element) != nullptr);
  const auto read = [&](const std::string& name, Location at, int components) {
    return scatter_field(distribution, snapshot, name, at, components);
  };
  const auto take = [&](const std::string& name, Location at, int components, std::size_t count,
                        double fallback) {
    auto values = stressed ? read(name, at, components) : std::vector<double>{};
    if (values.empty()) values.assign(count, fallback);
    return values;
  };
  body.now.p = take(field::pressure, Location::element, 1, elements, 0);
  for (double& p : body.now.p) p = -p;
  body.now.volume_ratio =
      fill_slots(take(field::volume_ratio, Location::quadrature_point, 1, points, 1), rule);
  body.element_stress = take(field::cauchy_stress, Location::element, 6, elements * 6, 0);
  body.point_stress = take(field::cauchy_stress, Location::quadrature_point, 6, points * 6, 0);
  body.volumes = stressed ? read(field::volume, Location::element, 1) : std::vector<double>{};
  body.displacement = read(field::displacement, Location::node, 3);
  if (body.displacement.empty()) body.displacement.assign(body.now.x.size(), 0);
  return body;
}

std::vector<FieldPart> body_fields(const BodyState& body, const BodyLayout& layout,
                                   const LocalMesh& local,
                                   const std::vector<double>& reference_volumes,
                                   const Predictor& predictor) {
  const PointRule& rule = layout.rule;
  const auto points = static_cast<std::size_t>(rule.points);
  std::vector<FieldPart> parts;
  add_state_fields(body, layout, parts);
  const auto add = [&](const std::string& name, Location location, int components,
                       const std::string& unit, Transport transport, const std::string& description,
                       AppendRows append) {
    const auto width = static_cast<std::size_t>(components);
    const std::size_t each = location == Location::quadrature_point ? width * points : width;
    FieldPart field;
    field.outline.name = name;
    field.outline.location = location;
    field.outline.components = components;
    field.outline.unit = unit;
    field.outline.transport = transport;
    field.outline.description = description;
    field.each = each;
    field.append = std::move(append);
    parts.push_back(std::move(field));
  };
  const AppendRows pressures = [&body, mixed = layout.mixed](std::size_t first, std::size_t last,
                                                             std::vector<double>& out) {
    for (std::size_t e = first; e < last; ++e) {
      const double* s = &body.element_stress[6 * e];
      out.push_back(mixed ? -body.now.p[e] : -(s[0] + s[1] + s[2]) / 3);
    }
  };
  const AppendRows partition = [rank = rank_of(local.comm)](std::size_t first, std::size_t last,
                                                            std::vector<double>& out) {
    out.insert(out.end(), last - first, rank);
  };
  const AppendRows ratios = [&body, &rule](std::size_t first, std::size_t last,
                                           std::vector<double>& out) {
    for (std::size_t e = first; e < last; ++e) {
      const auto begin =
          body.now.volume_ratio.begin() + static_cast<std::ptrdiff_t>(e) * rule.slots;
      out.insert(out.end(), begin, begin + rule.points);
    }
  };
  add(field::displacement, Location::node, 3, "L", Transport::shape_functions,
      "from the initial position", rows_of(body.displacement, 3));
  add(field::reference_volume, Location::element, 1, "L^3", Transport::not_carried,
      "volume at zero pressure", rows_of(reference_volumes, 1));
  add(field::volume, Location::element, 1, "L^3", Transport::not_carried,
      "volume, by the points' quadrature", rows_of(body.volumes, 1));
  add(field::cauchy_stress, Location::element, 6, "MPa", Transport::reset_to_zero,
      "mean Cauchy stress: xx yy zz yz zx xy", rows_of(body.element_stress, 6));
  add(field::cauchy_stress, Location::quadrature_point, 6, "MPa", Transport::reset_to_zero,
      "Cauchy stress: xx yy zz yz zx xy", rows_of(body.point_stress, 6 * points));
  add(field::pressure, Location::element, 1, "MPa", Transport::reset_to_zero,
      "minus the mean of the normal stresses", pressures);
  add(field::partition, Location::element, 1, "1", Transport::not_carried,
      "rank that works on the element", partition);
  add(field::rate, Location::node, 3, "L", Transport::not_carried,
      "predictor: departure from the homogeneous motion per unit strain, last step",
      rows_of(predictor.rate(), 3));
  add(field::previous_rate, Location::node, 3, "L", Transport::not_carried,
      "predictor: the same in the step before", rows_of(predictor.previous_rate(), 3));
  add(field::pressure_rate, Location::element, 1, "MPa", Transport::not_carried,
      "predictor: mean stress per unit strain", rows_of(predictor.pressure_rate(), 1));
  if (!layout.mixed)
    add(field::volume_ratio, Location::quadrature_point, 1, "1", Transport::not_carried,
        "volume of the point over its volume at zero pressure", ratios);
  return parts;
}

}  // namespace polyslip::solver
