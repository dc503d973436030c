#include "solver/secant_tangent.hpp"

#include <cmath>

#include "solver/lanes.hpp"

namespace polyslip::solver {
namespace {

const double half_sqrt2 = std::sqrt(0.5);
/// Entry 3 k + l of a tensor and the Mandel component it belongs to.
constexpr int mandel[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
constexpr int diagonal[3] = {0, 4, 8};

/// A symmetric tensor's nine entries from its Mandel components.
inline void plain(const Points v[6], Points out[9]) {
  for (int k = 0; k < 9; ++k) out[k] = (mandel[k] < 3 ? 1.0 : half_sqrt2) * v[mandel[k]];
}

inline Points dot(const Points a[6], const Points b[6]) {
  Points sum = a[0] * b[0];
  for (int m = 1; m < 6; ++m) sum += a[m] * b[m];
  return sum;
}

/// D h, Mandel
inline void apply(const double* tangent, const Points h[9], Points out[6]) {
  for (int m = 0; m < 6; ++m) {
    out[m] = Points{};
    for (int k = 0; k < 9; ++k) out[m] += load_points(tangent + 4 * (9 * m + k)) * h[k];
  }
}

}  // namespace

void match_last_change(const double* h, const double* change, double stiffest, double* tangent) {
  Points strain[9], rest[9];  // h = strain + rest
  for (int k = 0; k < 9; ++k) {
    const Points here = load_points(h + 4 * k);
    strain[k] = 0.5 * (here + load_points(h + 4 * (3 * (k % 3) + k / 3)));
    rest[k] = here - strain[k];
  }
  const Points third = (strain[0] + strain[4] + strain[8]) / 3.0;
  for (const int k : diagonal) strain[k] -= third, rest[k] += third;
  const Points s[6] = {strain[0],
                       strain[4],
                       strain[8],
                       strain[5] / half_sqrt2,
                       strain[2] / half_sqrt2,
                       strain[1] / half_sqrt2};
  Points Ds[6], y[6];
  apply(tangent, strain, Ds);
  apply(tangent, rest, y);
  for (int m = 0; m < 6; ++m) y[m] = load_points(change + 4 * m) - y[m];

  const Points ys = dot(y, s), sDs = dot(Ds, s), one = Points{} + 1.0;
  const auto use = (ys > 0.0) & (sDs > 0.0) & (dot(y, y) <= stiffest * ys);
  const Points gain = use ? 1.0 / (use ? ys : one) : Points{};
  const Points loss = use ? 1.0 / (use ? sDs : one) : Points{};
  Points y_plain[9], Ds_plain[9];
  plain(y, y_plain);
  plain(Ds, Ds_plain);
  for (int m = 0; m < 6; ++m)
    for (int k = 0; k < 9; ++k) {
      double* at = tangent + 4 * (9 * m + k);
      store_points(at, load_points(at) + gain * y[m] * y_plain[k] - loss * Ds[m] * Ds_plain[k]);
    }
}

}  // namespace polyslip::solver
