#include "results/plot_axis.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace polyslip::results {
namespace {

/// 1, 2 or 5 times a power of ten, at least `rough`.
double round_step(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (rough <= factor * power * (1 + 1e-9)) return factor * power;
  return 10 * power;
}

std::string superscript(int number) {
  static constexpr std::array<const char*, 10> digits{"\u2070", "\u00b9", "\u00b2", "\u00b3",
                                                      "\u2074", "\u2075", "\u2076", "\u2077",
                                                      "\u2078", "\u2079"};
  std::string text = number < 0 ? "\u207b" : "";
  for (const char c : std::to_string(std::abs(number))) text += digits[c - '0'];
  return text;
}

/// 1, 10, 100 and 0.1, 0.01 in words, others as powers.
std::string decade_text(int exponent) {
  if (exponent >= -2 && exponent <= 3) return fmt::format("{:g}", std::pow(10.0, exponent));
  return "10" + superscript(exponent);
}

}  // namespace

Scale::Scale(double low, double high, bool logarithmic)
    : low_(low), high_(high), logarithmic_(logarithmic) {
  if (!(low < high) || !std::isfinite(high - low) || (logarithmic && !(low > 0)))
    throw core::InternalError(fmt::format("results/plot: an axis from {} to {}", low, high));
}

Scale Scale::round(double low, double high, bool logarithmic) {
  if (logarithmic) {
    const double first = std::floor(std::log10(low) + 1e-9);
    const double last = std::ceil(std::log10(high) - 1e-9);
    return {std::pow(10.0, first), std::pow(10.0, last > first ? last : first + 1), true};
  }
  if (!(high > low)) {
    const double half = low == 0 ? 1 : 0.1 * std::abs(low);
    return {low - half, high + half, false};
  }
  const double step = round_step((high - low) / 5);
  return {step * std::floor(low / step + 1e-9), step * std::ceil(high / step - 1e-9), false};
}

double Scale::place(double value) const {
  if (!std::isfinite(value) || (logarithmic_ && !(value > 0)))
    return std::numeric_limits<double>::quiet_NaN();
  if (logarithmic_) return std::log(value / low_) / std::log(high_ / low_);
  return (value - low_) / (high_ - low_);
}

std::vector<Tick> Scale::ticks(int wanted) const {
  std::vector<Tick> found;
  if (logarithmic_) {
    const int first = static_cast<int>(std::ceil(std::log10(low_) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(high_) + 1e-9));
    const int every = std::max(1, (last - first + 1 + wanted) / (wanted + 1));
    for (int e = first - 1; e <= last; ++e)
      for (int digit = 1; digit < 10; ++digit) {
        const double value = digit * std::pow(10.0, e);
        if (value < low_ * (1 - 1e-9) || value > high_ * (1 + 1e-9)) continue;
        const bool named = digit == 1 && (e - first) % every == 0;
        if (named || (every == 1 && digit > 1) || digit == 1)
          found.push_back({value, named ? decade_text(e) : ""});
      }
    return found;
  }
  const double step = round_step((high_ - low_) / wanted);
  const auto first = static_cast<long>(std::ceil(low_ / step - 1e-9));
  for (long i = first; static_cast<double>(i) * step <= high_ + 1e-9 * step; ++i) {
    const double value = static_cast<double>(i) * step;
    found.push_back({value, fmt::format("{:.6g}", value)});
  }
  return found;
}

}  // namespace polyslip::results
