#include "solver/krylov_operator.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "solver/lanes.hpp"
#include "solver/reference_element.hpp"

namespace polyslip::solver {
namespace {

constexpr int dofs = 3 * element_nodes;
const double half_sqrt2 = std::sqrt(0.5);

/// Gradients of a block's points: shape functions or mapping of a PointRule.
using BlockGradients = double[3][element_nodes][material::lanes];

/// Gradient in reference coordinates at the points of a block, [k][L] = du_k / dxi_L.
inline void reference_gradient(const BlockGradients& gradients, const double* u, Points h[3][3]) {
  for (int k = 0; k < 3; ++k)
    for (int L = 0; L < 3; ++L) h[k][L] = Points{};
  for (int b = 0; b < element_nodes; ++b)
    for (int L = 0; L < 3; ++L) {
      const Points g = load_points(gradients[L][b]);
      for (int k = 0; k < 3; ++k) h[k][L] += g * u[3 * b + k];
    }
}

/// f = sum over the points of T_ij dN_a/dx_j, T times the point's volume given.
/// geometry: [blocks][10][4]
template <int blocks>
inline void sum_forces(const PointRule& rule, const Points (&T)[blocks][3][3],
                       const double* geometry, double* f) {
  Points t[blocks][3][3];  // [i][L]
  for (int b = 0; b < blocks; ++b)
    for (int L = 0; L < 3; ++L) {
      const double* at = geometry + 40 * b + 4 * (1 + 3 * L);
      const Points x = load_points(at), y = load_points(at + 4), z = load_points(at + 8);
      for (int i = 0; i < 3; ++i) t[b][i][L] = T[b][i][0] * x + T[b][i][1] * y + T[b][i][2] * z;
    }
  for (int a = 0; a < element_nodes; ++a) {
    Points sum[3] = {};
    for (int b = 0; b < blocks; ++b)
      for (int L = 0; L < 3; ++L) {
        const Points g = load_points(rule.gradients[b][L][a]);
        for (int i = 0; i < 3; ++i) sum[i] += g * t[b][i][L];
      }
    for (int i = 0; i < 3; ++i) f[3 * a + i] = sum_points(sum[i]);
  }
}

/// sum over all points of an element
template <int blocks, class Term>
inline double sum_blocks(const Term& term) {
  Points sum = term(0);
  for (int b = 1; b < blocks; ++b) sum += term(b);
  return sum_points(sum);
}

/// Adds the coefficient of d(div u)_q in the forces of the points' volume resistance
/// (add_resistance_tangent in solver/point_volumes.hpp). w: volumes, d: divergences at the points;
/// reference, departure: W and s, [blocks][4].
template <int blocks>
inline void add_resistance(double kappa, const Points (&w)[blocks], const Points (&d)[blocks],
                           const double* reference, const double* departure, Points (&c)[blocks]) {
  Points W[blocks], s[blocks];
  for (int b = 0; b < blocks; ++b)
    W[b] = load_points(reference + 4 * b), s[b] = load_points(departure + 4 * b);
  const auto sum = [](const auto& term) { return sum_blocks<blocks>(term); };
  const double V = sum([&](int b) { return w[b]; }),
               mean = sum([&](int b) { return w[b] * d[b]; }) / V,
               weighted = sum([&](int b) { return W[b] * d[b]; }),
               all = sum([&](int b) { return W[b] + W[b] * s[b]; });
  for (int b = 0; b < blocks; ++b)
    c[b] +=
        kappa * (W[b] * (1.0 - s[b]) * d[b] - W[b] * mean + w[b] * ((all * mean - weighted) / V));
}

/// Stress and its change at the points of a block: M h of element_tangent without the bulk modulus,
/// times the volume w. stress: deviatoric; mean: mean stress.
inline void stress_change(const double* tangent, const double* stress, Points mean,
                          const Points h[3][3], Points w, Points T[3][3]) {
  Points s[6];  // D h
  for (int m = 0; m < 6; ++m) {
    s[m] = Points{};
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) s[m] += load_points(tangent + 4 * (9 * m + 3 * k + l)) * h[k][l];
  }
  // The terms of the moving geometry: sigma tr h - sigma h^T.
  const Points d = h[0][0] + h[1][1] + h[2][2];
  const Points yz = half_sqrt2 * load_points(stress + 12),
               zx = half_sqrt2 * load_points(stress + 16),
               xy = half_sqrt2 * load_points(stress + 20);
  const Points sigma[3][3] = {{load_points(stress) + mean, xy, zx},
                              {xy, load_points(stress + 4) + mean, yz},
                              {zx, yz, load_points(stress + 8) + mean}};
  const Points v[3][3] = {{s[0], half_sqrt2 * s[5], half_sqrt2 * s[4]},
                          {half_sqrt2 * s[5], s[1], half_sqrt2 * s[3]},
                          {half_sqrt2 * s[4], half_sqrt2 * s[3], s[2]}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      T[i][j] = w * (v[i][j] + sigma[i][j] * d - sigma[i][0] * h[j][0] - sigma[i][1] * h[j][1] -
                     sigma[i][2] * h[j][2]);
}

}  // namespace

KrylovOperator::KrylovOperator(const LinearLayout& layout)
    : layout_(layout),
      rule_(*layout.rule),
      threaded_(omp_get_max_threads() > 1),
      geometry_(10 * layout.local->elements.size() * static_cast<std::size_t>(rule_.slots)),
      u_(3 * static_cast<std::size_t>(layout.local->local_nodes)),
      y_(u_.size()) {
  if (!threaded_) return;
  sum_ = std::make_unique<NodeSum>(*layout.local);
  forces_.resize(dofs * layout.local->elements.size());
}

void KrylovOperator::set(const LinearBlocks& blocks) {
  blocks_ = blocks;
  const int n = layout_.local->element_count();
#pragma omp parallel for schedule(static)
  for (int e = 0; e < n; ++e) {
    double x[dofs];
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        x[3 * a + i] = blocks.x[3 * static_cast<std::size_t>(layout_.local->elements[e][a]) + i];
    for (int block = 0; block < rule_.blocks; ++block) {
      Points j[3][3];  // dx_i / dxi_L
      reference_gradient(rule_.mapping[block], x, j);
      const auto minor = [&](int i, int k) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        return j[i1][k1] * j[i2][k2] - j[i1][k2] * j[i2][k1];
      };
      const Points det = j[0][0] * minor(0, 0) + j[0][1] * minor(0, 1) + j[0][2] * minor(0, 2);
      double* out = &geometry_[40 * static_cast<std::size_t>(e * rule_.blocks + block)];
      store_points(out, load_points(rule_.weights[block]) * det);
      for (int L = 0; L < 3; ++L)
        for (int i = 0; i < 3; ++i) store_points(out + 4 * (1 + 3 * L + i), minor(i, L) / det);
    }
  }
}

template <class Call>
void KrylovOperator::with_blocks(const Call& call) const {
  static_assert(max_point_blocks == 4);  // 4, 8, 14 and 15 points stand in 1, 2, 4 and 4 blocks
  if (rule_.blocks == 1)
    call(std::integral_constant<int, 1>{});
  else if (rule_.blocks == 2)
    call(std::integral_constant<int, 2>{});
  else
    call(std::integral_constant<int, 4>{});
}

template <int blocks>
void KrylovOperator::element(int e, const double* p, double* yp, double* f) const {
  const auto at = static_cast<std::size_t>(e), first = 4 * blocks * at;
  double u[dofs];
  for (int a = 0; a < element_nodes; ++a)
    for (int i = 0; i < 3; ++i)
      u[3 * a + i] = u_[3 * static_cast<std::size_t>(layout_.local->elements[at][a]) + i];
  const double* geometry = &geometry_[10 * first];
  Points T[blocks][3][3], w[blocks], d[blocks], c[blocks];
  for (int b = 0; b < blocks; ++b) {
    Points r[3][3], h[3][3];
    reference_gradient(rule_.gradients[b], u, r);
    const double* g = geometry + 40 * b;
    for (int l = 0; l < 3; ++l) {
      const Points x = load_points(g + 4 * (1 + l)), y = load_points(g + 4 * (4 + l)),
                   z = load_points(g + 4 * (7 + l));
      for (int k = 0; k < 3; ++k) h[k][l] = r[k][0] * x + r[k][1] * y + r[k][2] * z;
    }
    w[b] = load_points(g);
    d[b] = h[0][0] + h[1][1] + h[2][2];
    c[b] = w[b] * (blocks_.bulk * d[b]);
    const std::size_t block = first + 4 * static_cast<std::size_t>(b);
    stress_change(blocks_.tangent + 54 * block, blocks_.stress + 6 * block,
                  load_points(blocks_.mean_stress + block), h, w[b], T[b]);
  }
  if (blocks_.kappa > 0)
    add_resistance(blocks_.kappa, w, d, blocks_.reference + first, blocks_.departure + first, c);
  if (layout_.mixed) {
    const double D = blocks_.scale[at], C = blocks_.C[at], W = blocks_.W[at];
    const double t = D * sum_blocks<blocks>([&](int b) { return w[b] * d[b]; });
    for (int b = 0; b < blocks; ++b) c[b] += w[b] * (D * (W * t + (1 - W * C) * p[at]));
    yp[at] = t - C * p[at];
  }
  for (int b = 0; b < blocks; ++b)
    for (int i = 0; i < 3; ++i) T[b][i][i] += c[b];
  sum_forces(rule_, T, geometry, f);
}

template <int blocks>
void KrylovOperator::volume_forces(int e, const double* c, double* f) const {
  const auto at = static_cast<std::size_t>(e);
  const double* geometry = &geometry_[40 * blocks * at];
  Points T[blocks][3][3] = {};
  for (int b = 0; b < blocks; ++b) {
    const Points push = load_points(geometry + 40 * b) * (blocks_.scale[at] * c[at]);
    for (int i = 0; i < 3; ++i) T[b][i][i] = push;
  }
  sum_forces(rule_, T, geometry, f);
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
  with_blocks(
      [&](auto blocks) { sum_elements([&](int e, double* f) { element<blocks>(e, p, yp, f); }); });
  layout_.exchange->add_ghosts(y_, 3);
  for (std::size_t i = 0; i < n; ++i) yu[i] = layout_.constrained[i] ? 0 : y_[i];
}

void KrylovOperator::add_volume_forces(const double* c, double* yu) {
  with_blocks([&](auto blocks) {
    sum_elements([&](int e, double* f) { volume_forces<blocks>(e, c, f); });
  });
  layout_.exchange->add_ghosts(y_, 3);
  for (std::size_t i = 0; i < layout_.displacements(); ++i)
    if (!layout_.constrained[i]) yu[i] += y_[i];
}

}  // namespace polyslip::solver
