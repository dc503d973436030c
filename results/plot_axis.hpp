#pragma once
// From values to places along an axis of a plot, and its ticks.

#include <string>
#include <vector>

namespace polyslip::results {

struct Tick {
  double value = 0;
  std::string text;  ///< empty: a minor tick
};

/// A stretch of an axis, from `low` to `high` in the values' own unit.
class Scale {
 public:
  /// `low` < `high`, both positive on a logarithmic scale; InternalError otherwise.
  Scale(double low, double high, bool logarithmic);
  /// Smallest scale with round ends that holds the values.
  static Scale round(double low, double high, bool logarithmic);

  /// 0 at the low end, 1 at the high one; NaN for what has no place.
  double place(double value) const;
  /// About `wanted` of them at round values; decades on a logarithmic scale.
  std::vector<Tick> ticks(int wanted) const;
  double low() const { return low_; }
  double high() const { return high_; }
  bool logarithmic() const { return logarithmic_; }

 private:
  double low_, high_;
  bool logarithmic_;
};

}  // namespace polyslip::results
