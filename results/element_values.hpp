#pragma once
// One value an element of the fields at quadrature points: mean, or value at the centroid.

#include <cstddef>
#include <vector>

#include "core/types.hpp"
#include "mesh/snapshot.hpp"

namespace polyslip::results {

enum class ElementValue {
  average,   ///< mean over the points, weighted by their share of the current (curved) volume
  centroid,  ///< of 15 points the one that lies there; else the best linear function through them
};

/// [elements] each, in the order of the mesh. A field that the snapshot lacks is NaN, but a
/// snapshot without stresses is free of them: zero.
struct ElementTable {
  std::vector<double> volume;                 ///< exact for curved elements
  std::vector<core::Vec3> centroid;           ///< of the curved volume
  std::vector<core::Quaternion> orientation;  ///< unit; the sign of the element's first point's
  std::vector<double> g;                      ///< MPa, mean over the components of "g"
  std::vector<double> slip;                   ///< sum over the components of "slip"
  std::vector<double> equivalent_strain;
  std::vector<core::Vec6> cauchy_stress;  ///< plain components xx yy zz yz zx xy, MPa
  std::vector<double> pressure;  ///< MPa: -tr of `cauchy_stress` / 3 (element field if no stress)
};

/// Stress: the quadrature-point field "cauchy_stress", or else the element field of that name.
/// Elements of order 1 are taken as straight ones. InternalError if a field has the wrong size, a
/// quaternion is zero or not finite, or there is no rule of so many points (one: a value an
/// element).
ElementTable element_values(const mesh::Snapshot& snapshot, ElementValue value);
/// The same for the elements first ... last - 1 of an outline.
ElementTable element_values(const mesh::Snapshot& outline, const mesh::FieldReader& read,
                            ElementValue value, std::size_t first, std::size_t last);

}  // namespace polyslip::results
