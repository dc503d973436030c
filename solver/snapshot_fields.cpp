#include "solver/snapshot_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

using mesh::Location;

std::size_t entities(const mesh::Snapshot& snapshot, Location location) {
  if (location == Location::node) return snapshot.mesh.nodes.size();
  const int each = location == Location::element ? 1 : snapshot.quadrature_points;
  return snapshot.mesh.tetrahedra.size() * static_cast<std::size_t>(each);
}

}  // namespace

std::size_t state_index(const PointRule& rule, int size, std::size_t element, int c, int slot) {
  return element * static_cast<std::size_t>(size) * static_cast<std::size_t>(rule.slots) +
         static_cast<std::size_t>(PointRule::at(size, c, slot));
}

void check_fields(const mesh::Snapshot& snapshot, const material::CrystalLaw& law, int points) {
  if (snapshot.mesh.order != 2 || snapshot.mesh.tetrahedra.empty())
    throw core::InternalError("Model: the snapshot needs a mesh of order 2");
  if (snapshot.quadrature_points != points)
    throw core::InternalError(fmt::format("Model: the snapshot has {} points an element, not {}",
                                          snapshot.quadrature_points, points));
  for (const auto& wanted : law.layout().fields) {
    const auto* f = snapshot.find(wanted.name, Location::quadrature_point);
    if (!f || f->components != wanted.components)
      throw core::InternalError(
          fmt::format("Model: the snapshot lacks the state field \"{}\"", wanted.name));
  }
  for (const auto& f : snapshot.fields)
    if (f.values.size() != entities(snapshot, f.location) * f.components)
      throw core::InternalError(
          fmt::format("Model: field \"{}\" has {} values", f.name, f.values.size()));
}

void append_state(const PointRule& rule, int size, int offset, int components,
                  const std::vector<double>& blocks, std::size_t first, std::size_t last,
                  std::vector<double>& out) {
  for (std::size_t e = first; e < last; ++e)
    for (int q = 0; q < rule.points; ++q)
      for (int c = 0; c < components; ++c)
        out.push_back(blocks[state_index(rule, size, e, offset + c, q)]);
}

void fill_state(const PointRule& rule, int size, int offset, int components,
                const std::vector<double>& values, std::vector<double>& blocks) {
  const auto each = static_cast<std::size_t>(components),
             points = static_cast<std::size_t>(rule.points);
  const std::size_t elements = values.size() / (each * points);
  for (std::size_t e = 0; e < elements; ++e)
    for (int slot = 0; slot < rule.slots; ++slot) {
      const auto q = static_cast<std::size_t>(std::min(slot, rule.points - 1));
      for (int c = 0; c < components; ++c)
        blocks[state_index(rule, size, e, offset + c, slot)] =
            values[(e * points + q) * each + static_cast<std::size_t>(c)];
    }
}

std::vector<double> values_of(const mesh::Snapshot& snapshot, const std::string& name,
                              Location location) {
  const auto* f = snapshot.find(name, location);
  return f ? f->values : std::vector<double>{};
}

std::vector<double> fill_slots(const std::vector<double>& values, const PointRule& rule) {
  std::vector<double> out;
  out.reserve(values.size() / static_cast<std::size_t>(rule.points) *
              static_cast<std::size_t>(rule.slots));
  const std::ptrdiff_t points = rule.points;
  for (auto at = values.begin(); at != values.end(); at += points) {
    out.insert(out.end(), at, at + points);
    out.insert(out.end(), static_cast<std::size_t>(rule.slots - rule.points), *(at + points - 1));
  }
  return out;
}

bool is_of_model(const mesh::Field& f, const material::CrystalLaw& law) {
  const auto is = [&](Location location, std::initializer_list<std::string> names) {
    return f.location == location && std::find(names.begin(), names.end(), f.name) != names.end();
  };
  const auto& state = law.layout().fields;
  return is(Location::node, {field::displacement, field::rate, field::previous_rate}) ||
         is(Location::element, {field::reference_volume, field::volume, field::cauchy_stress,
                                field::pressure, field::partition, field::pressure_rate}) ||
         is(Location::quadrature_point, {field::cauchy_stress, field::volume_ratio}) ||
         (f.location == Location::quadrature_point &&
          std::any_of(state.begin(), state.end(), [&](const auto& s) { return s.name == f.name; }));
}

void put(mesh::Snapshot& snapshot, mesh::Field field) {
  for (auto& f : snapshot.fields)
    if (f.name == field.name && f.location == field.location) {
      f = std::move(field);
      return;
    }
  snapshot.fields.push_back(std::move(field));
}

void put_state(mesh::Snapshot& snapshot, const material::CrystalLaw& law,
               const std::vector<double>& blocks) {
  const int size = law.layout().size();
  const PointRule& rule = point_rule(snapshot.quadrature_points);
  int offset = 0;
  for (const auto& part : law.layout().fields) {
    mesh::Field f{part.name,
                  Location::quadrature_point,
                  part.components,
                  part.unit,
                  part.transport,
                  part.description,
                  {}};
    f.values.reserve(entities(snapshot, f.location) * static_cast<std::size_t>(part.components));
    append_state(rule, size, offset, part.components, blocks, 0, snapshot.mesh.tetrahedra.size(),
                 f.values);
    put(snapshot, std::move(f));
    offset += part.components;
  }
}

}  // namespace polyslip::solver
