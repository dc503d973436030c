#include "solver/krylov_operator.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "solver/lanes.hpp"
#include "solver/reference_element.hpp"

namespace polyslip::solver {
namespace {

constexpr int dofs = 3 * element_nodes;
const double half_sqrt2 = std::sqrt(0.5);

/// Displacement gradient in reference coordinates at the points, [k][L] = du_k / dxi_L.
inline void reference_gradient(const double* u, Points h[3][3]) {
  const PointTable& table = point_table();
  for (int k = 0; k < 3; ++k)
    for (int L = 0; L < 3; ++L) h[k][L] = Points{};
  for (int b = 0; b < element_nodes; ++b)
    for (int L = 0; L < 3; ++L) {
      const Points g = load_points(table.gradients[L][b]);
      for (int k = 0; k < 3; ++k) h[k][L] += g * u[3 * b + k];
    }
}

/// f += sum over the points of T_ij dN_a/dx_j, T times the point's volume given.
inline void add_forces(const Points T[3][3], const double* geometry, double* f) {
  const PointTable& table = point_table();
  Points t[3][3];  // [i][L]
  for (int L = 0; L < 3; ++L) {
    const Points x = load_points(geometry + 4 * (1 + 3 * L)),
                 y = load_points(geometry + 4 * (2 + 3 * L)),
                 z = load_points(geometry + 4 * (3 + 3 * L));
    for (int i = 0; i < 3; ++i) t[i][L] = T[i][0] * x + T[i][1] * y + T[i][2] * z;
  }
  for (int a = 0; a < element_nodes; ++a) {
    const Points g0 = load_points(table.gradients[0][a]), g1 = load_points(table.gradients[1][a]),
                 g2 = load_points(table.gradients[2][a]);
    for (int i = 0; i < 3; ++i)
      f[3 * a + i] = sum_points(g0 * t[i][0] + g1 * t[i][1] + g2 * t[i][2]);
  }
}

/// Coefficient of d(div u)_q in the forces of the points' volume resistance (add_resistance_tangent
/// in solver/point_volumes.hpp), over kappa. w: volumes, d: divergences at the points.
inline Points resistance_coefficient(Points w, Points W, Points s, Points d) {
  const double V = sum_points(w), mean = sum_points(w * d) / V;
  const double weighted = sum_points(W * d), all = sum_points(W) + sum_points(W * s);
  return W * (1.0 - s) * d - W * mean + w * ((all * mean - weighted) / V);
}

}  // namespace

KrylovOperator::KrylovOperator(const LinearLayout& layout)
    : layout_(layout),
      threaded_(omp_get_max_threads() > 1),
      geometry_(40 * layout.local->elements.size()),
      u_(3 * static_cast<std::size_t>(layout.local->local_nodes)),
      y_(u_.size()) {
  if (!threaded_) return;
  sum_ = std::make_unique<NodeSum>(*layout.local);
  forces_.resize(dofs * layout.local->elements.size());
}

void KrylovOperator::set(const LinearBlocks& blocks) {
  blocks_ = blocks;
  const PointTable& table = point_table();
  const int n = layout_.local->element_count();
#pragma omp parallel for schedule(static)
  for (int e = 0; e < n; ++e) {
    double x[dofs];
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        x[3 * a + i] = blocks.x[3 * static_cast<std::size_t>(layout_.local->elements[e][a]) + i];
    Points j[3][3];  // dx_i / dxi_L
    reference_gradient(x, j);
    const auto minor = [&](int i, int k) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      return j[i1][k1] * j[i2][k2] - j[i1][k2] * j[i2][k1];
    };
    const Points det = j[0][0] * minor(0, 0) + j[0][1] * minor(0, 1) + j[0][2] * minor(0, 2);
    double* out = &geometry_[40 * static_cast<std::size_t>(e)];
    store_points(out, load_points(table.weights) * det);
    for (int L = 0; L < 3; ++L)
      for (int i = 0; i < 3; ++i) store_points(out + 4 * (1 + 3 * L + i), minor(i, L) / det);
  }
}

void KrylovOperator::element(int e, const double* p, double* yp, double* f) const {
  const auto at = static_cast<std::size_t>(e);
  double u[dofs];
  for (int a = 0; a < element_nodes; ++a)
    for (int i = 0; i < 3; ++i)
      u[3 * a + i] = u_[3 * static_cast<std::size_t>(layout_.local->elements[at][a]) + i];
  Points r[3][3], h[3][3];
  reference_gradient(u, r);
  const double* geometry = &geometry_[40 * at];
  for (int l = 0; l < 3; ++l) {
    const Points x = load_points(geometry + 4 * (1 + l)), y = load_points(geometry + 4 * (4 + l)),
                 z = load_points(geometry + 4 * (7 + l));
    for (int k = 0; k < 3; ++k) h[k][l] = r[k][0] * x + r[k][1] * y + r[k][2] * z;
  }
  // D h, then the terms of the moving geometry: sigma tr h - sigma h^T.
  const double* tangent = blocks_.tangent + 216 * at;
  Points s[6];
  for (int m = 0; m < 6; ++m) {
    s[m] = Points{};
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) s[m] += load_points(tangent + 4 * (9 * m + 3 * k + l)) * h[k][l];
  }
  const Points d = h[0][0] + h[1][1] + h[2][2], w = load_points(geometry);
  const double* stress = blocks_.stress + 24 * at;
  const Points mean = load_points(blocks_.mean_stress + 4 * at);
  const Points yz = half_sqrt2 * load_points(stress + 12),
               zx = half_sqrt2 * load_points(stress + 16),
               xy = half_sqrt2 * load_points(stress + 20);
  const Points sigma[3][3] = {{load_points(stress) + mean, xy, zx},
                              {xy, load_points(stress + 4) + mean, yz},
                              {zx, yz, load_points(stress + 8) + mean}};
  const Points v[3][3] = {{s[0], half_sqrt2 * s[5], half_sqrt2 * s[4]},
                          {half_sqrt2 * s[5], s[1], half_sqrt2 * s[3]},
                          {half_sqrt2 * s[4], half_sqrt2 * s[3], s[2]}};
  Points T[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      T[i][j] = w * (v[i][j] + sigma[i][j] * d - sigma[i][0] * h[j][0] - sigma[i][1] * h[j][1] -
                     sigma[i][2] * h[j][2]);
  Points c = w * (blocks_.bulk * d);
  if (blocks_.kappa > 0)
    c += blocks_.kappa * resistance_coefficient(w, load_points(blocks_.reference + 4 * at),
                                                load_points(blocks_.departure + 4 * at), d);
  if (layout_.mixed) {
    const double D = blocks_.scale[at], C = blocks_.C[at], W = blocks_.W[at];
    const double t = D * sum_points(w * d);
    c += w * (D * (W * t + (1 - W * C) * p[at]));
    yp[at] = t - C * p[at];
  }
  for (int i = 0; i < 3; ++i) T[i][i] += c;
  add_forces(T, geometry, f);
}

template <class Forces>
void KrylovOperator::sum_elements(const Forces& forces) {
  const LocalMesh& local = *layout_.local;
  const int n = local.element_count();
  if (threaded_) {
#pragma omp parallel for schedule(static)
    for (int e = 0; e < n; ++e) forces(e, &forces_[dofs * static_cast<std::size_t>(e)]);
    (*sum_)(forces_, y_.data());
    return;
  }
  std::fill(y_.begin(), y_.end(), 0.0);
  for (int e = 0; e < n; ++e) {
    double f[dofs];
    forces(e, f);
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        y_[3 * static_cast<std::size_t>(local.elements[e][a]) + i] += f[3 * a + i];
  }
}

void KrylovOperator::apply(const double* u, const double* p, double* yu, double* yp) {
  const Stage stage(layout_.exchange->profile(), "operator");
  const std::size_t n = layout_.displacements();
  std::copy_n(u, n, u_.begin());
  layout_.exchange->update_ghosts(u_, 3);
  sum_elements([&](int e, double* f) { element(e, p, yp, f); });
  layout_.exchange->add_ghosts(y_, 3);
  for (std::size_t i = 0; i < n; ++i) yu[i] = layout_.constrained[i] ? 0 : y_[i];
}

void KrylovOperator::add_volume_forces(const double* c, double* yu) {
  sum_elements([&](int e, double* f) {
    const auto at = static_cast<std::size_t>(e);
    const double* geometry = &geometry_[40 * at];
    const Points push = load_points(geometry) * (blocks_.scale[at] * c[at]);
    const Points T[3][3] = {{push, {}, {}}, {{}, push, {}}, {{}, {}, push}};
    add_forces(T, geometry, f);
  });
  layout_.exchange->add_ghosts(y_, 3);
  for (std::size_t i = 0; i < layout_.displacements(); ++i)
    if (!layout_.constrained[i]) yu[i] += y_[i];
}

}  // namespace polyslip::solver
