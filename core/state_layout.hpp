#pragma once
// What a material point remembers, and how each part of it crosses a remeshing. The type lives in
// core; material fills it; solver, remap and results obey it.

#include <string>
#include <vector>

namespace polyslip::core {

/// How a field is carried from an old mesh to a new one.
enum class Transport {
  element_average,      ///< the donor element's volume-weighted mean, at every point of the new one
  orientation_average,  ///< the same for unit quaternions (eigenvector mean, sign kept continuous)
  reset_to_zero,        ///< zero after a remeshing (stresses: the paper, section 2.3)
  shape_functions,      ///< nodal: interpolated in the old element that holds the node
  not_carried,          ///< dropped at a remeshing (solver history, derived output)
};

/// One part of the state at a material point.
struct StateField {
  std::string name;    ///< "orientation", "elastic_strain", "g", "slip", "equivalent_strain"
  int components = 1;  ///< consecutive doubles
  std::string unit;    ///< "MPa", "1", ...
  Transport transport = Transport::element_average;
  std::string description;
};

/// The parts in the order in which they are stored. `size()` doubles a point.
struct StateLayout {
  std::vector<StateField> fields;

  int size() const {
    int n = 0;
    for (const auto& f : fields) n += f.components;
    return n;
  }
  /// First component of the field `name`; -1 if there is none.
  int offset(const std::string& name) const {
    int n = 0;
    for (const auto& f : fields) {
      if (f.name == name) return n;
      n += f.components;
    }
    return -1;
  }
};

}  // namespace polyslip::core
