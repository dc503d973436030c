#pragma once
// The quantities of a state that the page colours by and plots.

#include <array>
#include <string>
#include <vector>

#include "results/element_values.hpp"

namespace polyslip::results::report {

struct Quantity {
  std::string name, label, unit;
};

/// g, slip, equivalent_strain, von_mises, pressure, spread, radius_ratio.
inline constexpr std::size_t quantity_count = 7;
const std::array<Quantity, quantity_count>& quantities();

/// sqrt(3/2 s:s) of plain components xx yy zz yz zx xy.
double von_mises(const core::Vec6& stress);

struct StateValues {
  std::vector<double> volume;                 ///< [element]
  std::vector<core::Quaternion> orientation;  ///< [element]
  /// [grain] mean by volume, core::mean_rotation.
  std::vector<core::Quaternion> grain_orientation;
  std::vector<double> grain_volume;  ///< [grain]
  /// [quantity][element] g, pressure and the stress sqrt(3/2 s:s) in MPa; "spread" is the angle
  /// from the mean orientation of the grain [degrees]; NaN where the state has no such field.
  std::array<std::vector<double>, quantity_count> values;
};

StateValues values_of(const mesh::Snapshot& snapshot);

/// Of one quantity in one state.
struct Range {
  double min = 0, max = 0, mean = 0;  ///< mean by volume
  double low = 0, high = 0;           ///< first and last per cent lie outside
};

/// Of the finite values; NaN throughout if there is none.
Range range_of(const std::vector<double>& values, const std::vector<double>& volume);

}  // namespace polyslip::results::report
