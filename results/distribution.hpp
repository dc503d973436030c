#pragma once
// Moments, percentiles and histograms of many values.

#include <array>
#include <limits>
#include <vector>

namespace polyslip::results {

/// The percentiles that a Distribution gives.
inline constexpr std::array<int, 9> percentile_ranks{1, 5, 10, 25, 50, 75, 90, 95, 99};

struct Distribution {
  long count = 0;  ///< of finite values; the others are counted in `undefined`
  long undefined = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< root mean square, about mean
  double min = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
  /// [percentile_ranks] linear between the order statistics: rank p of n values is at
  /// p/100 (n - 1), from 0.
  std::array<double, percentile_ranks.size()> percentiles{};

  double percentile(int rank) const;  ///< InternalError for a rank that is not in the list
};

/// NaN throughout if no value is finite.
Distribution describe(std::vector<double> values);
Distribution describe(std::vector<float> values);

/// Counts in bins of one width; what lies outside is counted apart.
struct Histogram {
  double from = 0, width = 1;
  std::vector<long> counts;
  long below = 0, above = 0;  ///< outside; not a number: nowhere

  Histogram(double first, double last, int bins);
  /// A value at the end of the last bin counts in it.
  void add(double value);
  long total() const;  ///< below and above too
  double edge(int bin) const { return from + width * bin; }
  double centre(int bin) const { return from + width * (bin + 0.5); }
  /// [bins] share of all values in a bin, divided by its width.
  std::vector<double> density() const;
  /// [bins + 1] share of all values below each edge.
  std::vector<double> cumulative() const;
};

}  // namespace polyslip::results
