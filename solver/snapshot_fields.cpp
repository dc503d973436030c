#include "solver/snapshot_fields.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

using mesh::Location;
constexpr std::size_t lanes = material::lanes;

std::size_t entities(const mesh::Mesh& mesh, Location location) {
  if (location == Location::node) return mesh.nodes.size();
  return mesh.tetrahedra.size() * (location == Location::element ? 1 : lanes);
}

}  // namespace

void check_fields(const mesh::Snapshot& snapshot, const material::CrystalLaw& law) {
  if (snapshot.mesh.order != 2 || snapshot.quadrature_points != material::lanes ||
      snapshot.mesh.tetrahedra.empty())
    throw core::InternalError(
        "Model: the snapshot needs a mesh of order 2, four points an element");
  for (const auto& wanted : law.layout().fields) {
    const auto* f = snapshot.find(wanted.name, Location::quadrature_point);
    if (!f || f->components != wanted.components)
      throw core::InternalError(
          fmt::format("Model: the snapshot lacks the state field \"{}\"", wanted.name));
  }
  for (const auto& f : snapshot.fields)
    if (f.values.size() != entities(snapshot.mesh, f.location) * f.components)
      throw core::InternalError(
          fmt::format("Model: field \"{}\" has {} values", f.name, f.values.size()));
}

std::vector<double> state_blocks(const mesh::Snapshot& snapshot, const material::CrystalLaw& law) {
  const auto size = static_cast<std::size_t>(law.layout().size());
  const std::size_t elements = snapshot.mesh.tetrahedra.size();
  std::vector<double> blocks(elements * size * lanes);
  std::size_t offset = 0;
  for (const auto& wanted : law.layout().fields) {
    const auto& values = snapshot.find(wanted.name, Location::quadrature_point)->values;
    const auto components = static_cast<std::size_t>(wanted.components);
    for (std::size_t e = 0; e < elements; ++e)
      for (std::size_t q = 0; q < lanes; ++q)
        for (std::size_t c = 0; c < components; ++c)
          blocks[(e * size + offset + c) * lanes + q] = values[(e * lanes + q) * components + c];
    offset += components;
  }
  return blocks;
}

std::vector<double> values_of(const mesh::Snapshot& snapshot, const std::string& name,
                              Location location) {
  const auto* f = snapshot.find(name, location);
  return f ? f->values : std::vector<double>{};
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
  const auto size = static_cast<std::size_t>(law.layout().size());
  const std::size_t elements = snapshot.mesh.tetrahedra.size();
  std::size_t offset = 0;
  for (const auto& part : law.layout().fields) {
    const auto components = static_cast<std::size_t>(part.components);
    mesh::Field f{part.name,
                  Location::quadrature_point,
                  part.components,
                  part.unit,
                  part.transport,
                  part.description,
                  {}};
    f.values.resize(elements * lanes * components);
    for (std::size_t e = 0; e < elements; ++e)
      for (std::size_t q = 0; q < lanes; ++q)
        for (std::size_t c = 0; c < components; ++c)
          f.values[(e * lanes + q) * components + c] = blocks[(e * size + offset + c) * lanes + q];
    put(snapshot, std::move(f));
    offset += components;
  }
}

}  // namespace polyslip::solver
