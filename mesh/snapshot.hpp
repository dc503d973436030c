#pragma once
// What one stage hands to the next: a mesh, its fields, time, strain, provenance. Held by rank 0.
// A snapshot whose fields have no values is an outline; a FieldReader gives them piece by piece.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/state_layout.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

enum class Location { node, element, quadrature_point };

struct Field {
  std::string name;
  Location location = Location::element;
  int components = 1;
  std::string unit;
  core::Transport transport = core::Transport::not_carried;
  std::string description;
  /// [entities][components]; quadrature points: entity = element * quadrature_points + point.
  std::vector<double> values;
};

/// `mesh.nodes` are the current positions (already deformed). Fields by convention:
///   node: "displacement" (3, shape_functions, from the first mesh's positions);
///   element: "reference_volume" (V0 of p = K ln(V/V0); reset at a remeshing), "cauchy_stress" (6,
///   xx yy zz yz zx xy, MPa, average), "pressure" (-tr sigma / 3), "volume"; the partition;
///   quadrature_point: each StateField of the material, by its name; "cauchy_stress" (6, xx yy zz
///   yz zx xy, MPa, plain components, sample frame; reset_to_zero).
/// Names are unique within a location only: ask with the location where both may be there.
/// Solver history (predictor, step control) travels in fields and `history` marked not_carried.
struct Snapshot {
  Mesh mesh;
  int mesh_number = 0;  ///< 0 for the first mesh, +1 a remeshing
  int quadrature_points = 4;
  std::vector<Field> fields;
  std::map<std::string, std::vector<double>> history;
  double time = 0;                                ///< s
  double strain = 0;                              ///< ln(h0/h)
  std::map<std::string, std::string> provenance;  ///< version, deck hash, seed, ...

  const Field* find(const std::string& name) const {
    for (const auto& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
  Field* find(const std::string& name) {
    for (auto& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
  const Field* find(const std::string& name, Location location) const {
    for (const auto& f : fields)
      if (f.location == location && f.name == name) return &f;
    return nullptr;
  }
  Field* find(const std::string& name, Location location) {
    for (auto& f : fields)
      if (f.location == location && f.name == name) return &f;
    return nullptr;
  }
};

/// Reads a field of an outline: its values at the nodes or elements first ... last - 1 (of a field
/// at quadrature points: at the elements' points), [last - first][points][components].
using FieldReader =
    std::function<std::vector<double>(const Field& field, std::size_t first, std::size_t last)>;

/// Nodes or elements that a field's values belong to.
inline std::size_t owner_count(const Snapshot& snapshot, const Field& field) {
  return field.location == Location::node ? snapshot.mesh.nodes.size()
                                          : snapshot.mesh.tetrahedra.size();
}
/// Values of a field at each of them.
inline std::size_t values_each(const Snapshot& snapshot, const Field& field) {
  const int points = field.location == Location::quadrature_point ? snapshot.quadrature_points : 1;
  return static_cast<std::size_t>(points) * static_cast<std::size_t>(field.components);
}

/// Reads the values that the snapshot itself holds; it has to outlive the reader, which throws
/// core::InternalError for a field of the wrong size.
FieldReader reader_of(const Snapshot& snapshot);

}  // namespace polyslip::mesh
