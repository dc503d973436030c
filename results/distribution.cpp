#include "results/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace polyslip::results {
namespace {

template <class Number>
double at_rank(const std::vector<Number>& sorted, double rank) {
  const double place = rank / 100 * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  const double share = place - static_cast<double>(low);
  return (1 - share) * static_cast<double>(sorted[low]) + share * static_cast<double>(sorted[high]);
}

template <class Number>
Distribution describe_any(std::vector<Number> values) {
  Distribution d;
  const std::size_t all = values.size();
  std::erase_if(values, [](Number v) { return !std::isfinite(v); });
  d.count = static_cast<long>(values.size());
  d.undefined = static_cast<long>(all - values.size());
  d.percentiles.fill(std::numeric_limits<double>::quiet_NaN());
  if (values.empty()) return d;
  std::sort(values.begin(), values.end());
  double sum = 0, squares = 0;
  for (const Number v : values) sum += v;
  d.mean = sum / static_cast<double>(d.count);
  for (const Number v : values) squares += (v - d.mean) * (v - d.mean);
  d.deviation = std::sqrt(squares / static_cast<double>(d.count));
  d.min = values.front();
  d.max = values.back();
  for (std::size_t i = 0; i < percentile_ranks.size(); ++i)
    d.percentiles[i] = at_rank(values, percentile_ranks[i]);
  return d;
}

}  // namespace

double Distribution::percentile(int rank) const {
  for (std::size_t i = 0; i < percentile_ranks.size(); ++i)
    if (percentile_ranks[i] == rank) return percentiles[i];
  throw core::InternalError(fmt::format("results/distribution: no percentile {}", rank));
}

Distribution describe(std::vector<double> values) { return describe_any(std::move(values)); }
Distribution describe(std::vector<float> values) { return describe_any(std::move(values)); }

Histogram::Histogram(double first, double last, int bins)
    : from(first), width((last - first) / bins), counts(bins > 0 ? bins : 0, 0) {
  if (!(last > first) || bins < 1)
    throw core::InternalError(
        fmt::format("results/distribution: {} bins from {} to {}", bins, first, last));
}

void Histogram::add(double value) {
  if (std::isnan(value)) return;
  const auto bins = static_cast<double>(counts.size());
  const double place = (value - from) / width;
  if (place < 0)
    ++below;
  else if (place > bins)
    ++above;
  else
    ++counts[std::min(static_cast<std::size_t>(place), counts.size() - 1)];
}

long Histogram::total() const {
  long sum = below + above;
  for (const long n : counts) sum += n;
  return sum;
}

std::vector<double> Histogram::density() const {
  const auto all = static_cast<double>(total());
  std::vector<double> values;
  for (const long n : counts)
    values.push_back(all > 0 ? static_cast<double>(n) / (all * width) : 0);
  return values;
}

std::vector<double> Histogram::cumulative() const {
  const auto all = static_cast<double>(total());
  double sum = static_cast<double>(below);
  std::vector<double> values{all > 0 ? sum / all : 0};
  for (const long n : counts) {
    sum += static_cast<double>(n);
    values.push_back(all > 0 ? sum / all : 0);
  }
  return values;
}

}  // namespace polyslip::results
