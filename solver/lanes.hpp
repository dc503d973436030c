#pragma once
// Vectors of the compiler for kernels over points and elements.

#include <cstring>

namespace polyslip::solver {

/// Four doubles: the points of a block.
typedef double Points __attribute__((vector_size(32)));
/// Elements that are treated together in single precision.
inline constexpr int group_lanes = 16;
typedef float Lanes __attribute__((vector_size(4 * group_lanes)));

inline Points load_points(const double* from) {
  Points v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store_points(double* to, Points v) { std::memcpy(to, &v, sizeof v); }
inline double sum_points(Points v) { return (v[0] + v[1]) + (v[2] + v[3]); }

inline Lanes load_lanes(const float* from) {
  Lanes v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store_lanes(float* to, Lanes v) { std::memcpy(to, &v, sizeof v); }

}  // namespace polyslip::solver
