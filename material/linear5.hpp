#pragma once
// Five linear equations, four points at a time. Private to material.

#include "material/vector_tensor.hpp"

namespace polyslip::material::simd {

/// LU factors without pivoting, for the matrices of jacobian().
struct Factors {
  v4 a[5][5];  ///< unit lower and upper triangle
  v4 inverse_pivot[5];
};

inline Factors factorise(const Vec5v* rows) {
  Factors f;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) f.a[i][j] = rows[i][j];
  }
  for (int k = 0; k < 5; ++k) {
    f.inverse_pivot[k] = 1.0 / f.a[k][k];
    for (int i = k + 1; i < 5; ++i) {
      f.a[i][k] *= f.inverse_pivot[k];
      for (int j = k + 1; j < 5; ++j) f.a[i][j] -= f.a[i][k] * f.a[k][j];
    }
  }
  return f;
}

inline Vec5v solve(const Factors& f, Vec5v x) {
  for (int i = 1; i < 5; ++i) {
    for (int j = 0; j < i; ++j) x[i] -= f.a[i][j] * x[j];
  }
  for (int i = 4; i >= 0; --i) {
    for (int j = i + 1; j < 5; ++j) x[i] -= f.a[i][j] * x[j];
    x[i] *= f.inverse_pivot[i];
  }
  return x;
}

}  // namespace polyslip::material::simd
