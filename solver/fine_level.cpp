#include "solver/fine_level.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/tensor.hpp"
#include "mesh/shape_functions.hpp"
#include "solver/lanes.hpp"
#include "solver/reference_element.hpp"

namespace polyslip::solver {
namespace {

constexpr int dofs_of_element = 3 * element_nodes;
constexpr float inv_sqrt2 = 0.70710678118654752f, inv_sqrt6 = 0.40824829046386302f;

constexpr int upper(int i, int j) {  // of a 5 x 5 matrix, row by row
  return i <= j ? 5 * i - i * (i - 1) / 2 + (j - i) : upper(j, i);
}

/// One point of sixteen elements.
struct PointLanes {
  const float* at;
  Lanes volume() const { return load_lanes(at); }
  Lanes jacobian(int L, int l) const { return load_lanes(at + group_lanes * (1 + 3 * L + l)); }
  Lanes modulus(int i, int j) const { return load_lanes(at + group_lanes * (10 + upper(i, j))); }
};

/// Modes (core::deviator5) of the displacement e_i N with the gradient g of N: E[mode][i].
inline void node_modes(const Lanes g[3], Lanes E[5][3]) {
  const Lanes zero{};
  const Lanes x = inv_sqrt2 * g[0], y = inv_sqrt2 * g[1], z = inv_sqrt2 * g[2];
  E[0][0] = x, E[0][1] = -y, E[0][2] = zero;
  E[1][0] = -inv_sqrt6 * g[0], E[1][1] = -inv_sqrt6 * g[1], E[1][2] = 2 * inv_sqrt6 * g[2];
  E[2][0] = zero, E[2][1] = z, E[2][2] = y;
  E[3][0] = z, E[3][1] = zero, E[3][2] = x;
  E[4][0] = y, E[4][1] = x, E[4][2] = zero;
}

/// S = w D5 E
inline void stress_of(const PointLanes& p, const Lanes E[5][3], Lanes S[5][3]) {
  for (int m = 0; m < 5; ++m)
    for (int i = 0; i < 3; ++i) S[m][i] = Lanes{};
  for (int m = 0; m < 5; ++m)
    for (int n = 0; n < 5; ++n) {
      const Lanes d = p.modulus(m, n);
      for (int i = 0; i < 3; ++i) S[m][i] += d * E[n][i];
    }
}

/// Gradient in space of a function with the given reference gradient.
inline void space_gradient(const PointLanes& p, const float (&reference)[3], Lanes g[3]) {
  for (int l = 0; l < 3; ++l)
    g[l] = reference[0] * p.jacobian(0, l) + reference[1] * p.jacobian(1, l) +
           reference[2] * p.jacobian(2, l);
}

/// f_ai = sum_L N_a,L t_iL at one point, t_iL = T_ij dxi_L/dx_j. N: [direction][node] dN_a / dxi_L
inline void add_forces(const PointLanes& p, const std::array<std::array<float, 10>, 3>& N,
                       const Lanes T[3][3], Lanes* f) {
  Lanes t[3][3];
  for (int L = 0; L < 3; ++L)
    for (int i = 0; i < 3; ++i)
      t[i][L] =
          T[i][0] * p.jacobian(L, 0) + T[i][1] * p.jacobian(L, 1) + T[i][2] * p.jacobian(L, 2);
  for (int a = 0; a < element_nodes; ++a)
    for (int i = 0; i < 3; ++i)
      f[3 * a + i] += N[0][a] * t[i][0] + N[1][a] * t[i][1] + N[2][a] * t[i][2];
}

}  // namespace

FineLevel::FineLevel(const LinearLayout& layout)
    : layout_(layout), element_points_(layout.rule->points), threaded_(omp_get_max_threads() > 1) {
  const PointRule& rule = *layout.rule;
  gradients_.resize(static_cast<std::size_t>(element_points_));
  for (int q = 0; q < element_points_; ++q)
    for (int L = 0; L < 3; ++L)
      for (int a = 0; a < element_nodes; ++a)
        gradients_[q][L][a] = static_cast<float>(rule.point_gradients[q][L][a]);
  const LocalMesh& local = *layout.local;
  const int n = local.element_count();
  groups_ = (n + group_lanes - 1) / group_lanes;
  const std::size_t lanes = static_cast<std::size_t>(groups_) * group_lanes;
  nodes_.resize(10 * lanes);
  for (std::size_t k = 0; k < lanes; ++k)
    for (std::size_t a = 0; a < 10; ++a)
      nodes_[(k / group_lanes * 10 + a) * group_lanes + k % group_lanes] =
          3 * local.elements[std::min(k, static_cast<std::size_t>(n - 1))][a];
  points_.assign(lanes * static_cast<std::size_t>(element_points_) * point_values, 0.0f);
  for (auto* v : {&alpha_, &beta_, &inverse_volume_, &scale_}) v->assign(lanes, 0.0f);
  inverse_diagonal_.resize(9 * static_cast<std::size_t>(local.owned_nodes));
  y_.resize(local_dofs());
  if (!threaded_) return;
  sum_ = std::make_unique<NodeSum>(local);
  forces_.resize(dofs_of_element * local.elements.size());
}

const float* FineLevel::point(int group, int q) const {
  return &points_[static_cast<std::size_t>(group * element_points_ + q) * point_values *
                  group_lanes];
}

int FineLevel::lanes_of(int group) const {
  return std::min(group_lanes, layout_.local->element_count() - group_lanes * group);
}

void FineLevel::set(const KrylovOperator& fine) {
  const Stage stage(layout_.exchange->profile(), "fine level");
  const int n = layout_.local->element_count();
#pragma omp parallel for schedule(static)
  for (int e = 0; e < n; ++e) set_element(fine, e);
  set_diagonal();
}

void FineLevel::set_element(const KrylovOperator& fine, int element) {
  const auto e = static_cast<std::size_t>(element);
  const LinearBlocks& blocks = fine.blocks();
  const auto n_blocks = static_cast<std::size_t>(fine.rule().blocks);
  double V = 0;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const double* geometry = &fine.geometry()[40 * (n_blocks * e + b)];
    set_points(element, static_cast<int>(b), geometry, blocks.tangent + 216 * (n_blocks * e + b));
    V += sum_points(load_points(geometry));
  }
  const double D = layout_.mixed ? blocks.scale[e] : 0;
  const double augmentation = layout_.mixed ? blocks.W[e] * D * D * V : 0;
  alpha_[e] = static_cast<float>(blocks.kappa + blocks.bulk);
  beta_[e] = static_cast<float>(augmentation - blocks.kappa);
  inverse_volume_[e] = static_cast<float>(1 / V);
  scale_[e] = static_cast<float>(D);
}

void FineLevel::set_points(int element, int block, const double* geometry, const double* tangent) {
  const auto e = static_cast<std::size_t>(element);
  const std::size_t group = e / group_lanes, lane = e % group_lanes;
  // M[m][i]: mode m of Mandel component i.
  static const auto basis = [] {
    std::array<std::array<double, 6>, 5> M{};
    for (int m = 0; m < 5; ++m)
      for (int i = 0; i < 6; ++i) M[m][i] = core::mandel_of_deviator5(core::Vec5::Unit(m))[i];
    return M;
  }();
  const Points half = Points{} + 0.5;
  Points rows[5][6];  // modes of the stress for the symmetric gradients, Mandel
  for (int m = 0; m < 5; ++m) {
    Points r[9] = {};
    for (int i = 0; i < 6; ++i) {
      if (basis[m][i] == 0) continue;
      for (int kl = 0; kl < 9; ++kl) r[kl] += basis[m][i] * load_points(tangent + 4 * (9 * i + kl));
    }
    const double root2 = std::sqrt(2.0);
    rows[m][0] = r[0], rows[m][1] = r[4], rows[m][2] = r[8];
    rows[m][3] = root2 * half * (r[5] + r[7]);
    rows[m][4] = root2 * half * (r[2] + r[6]);
    rows[m][5] = root2 * half * (r[1] + r[3]);
  }
  const auto entry = [&](int m, int n) {
    Points sum{};
    for (int i = 0; i < 6; ++i)
      if (basis[n][i] != 0) sum += basis[n][i] * rows[m][i];
    return sum;
  };
  const Points w = load_points(geometry);
  const int first = material::lanes * block,
            count = std::min(material::lanes, element_points_ - first);
  const auto put = [&](int value, Points v) {
    for (int q = 0; q < count; ++q)
      points_[((group * static_cast<std::size_t>(element_points_) +
                static_cast<std::size_t>(first + q)) *
                   point_values +
               value) *
                  group_lanes +
              lane] = static_cast<float>(v[q]);
  };
  for (int i = 0; i < 10; ++i) put(i, load_points(geometry + 4 * i));
  for (int m = 0; m < 5; ++m)
    for (int n = m; n < 5; ++n)
      put(10 + upper(m, n), w * half * (m == n ? 2 * entry(m, m) : entry(m, n) + entry(n, m)));
}

void FineLevel::diagonal_of(int group, float* out) const {
  const std::size_t first = static_cast<std::size_t>(group) * group_lanes;
  const Lanes alpha = load_lanes(&alpha_[first]), beta = load_lanes(&beta_[first]);
  const Lanes inverse_volume = load_lanes(&inverse_volume_[first]);
  for (int a = 0; a < element_nodes; ++a) {
    Lanes K[3][3] = {}, mean[3] = {};
    for (int q = 0; q < element_points_; ++q) {
      const PointLanes p{point(group, q)};
      const auto& N = gradients_[q];
      Lanes g[3], E[5][3], S[5][3];
      space_gradient(p, {N[0][a], N[1][a], N[2][a]}, g);
      node_modes(g, E);
      stress_of(p, E, S);
      const Lanes w = p.volume();
      for (int i = 0; i < 3; ++i) {
        mean[i] += w * g[i];
        for (int j = 0; j < 3; ++j) {
          K[i][j] += alpha * w * g[i] * g[j];
          for (int m = 0; m < 5; ++m) K[i][j] += E[m][i] * S[m][j];
        }
      }
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        store_lanes(out + group_lanes * (9 * a + 3 * i + j),
                    K[i][j] + beta * inverse_volume * mean[i] * mean[j]);
  }
}

void FineLevel::set_diagonal() {
  const LocalMesh& local = *layout_.local;
  std::vector<float> diagonal(9 * static_cast<std::size_t>(local.local_nodes), 0.0f);
  std::vector<float> blocks(90 * group_lanes);
  for (int g = 0; g < groups_; ++g) {
    diagonal_of(g, blocks.data());
    for (int lane = 0; lane < lanes_of(g); ++lane)
      for (int a = 0; a < element_nodes; ++a) {
        const std::size_t node = static_cast<std::size_t>(
            local.elements[static_cast<std::size_t>(g) * group_lanes + lane][a]);
        for (std::size_t k = 0; k < 9; ++k)
          diagonal[9 * node + k] += blocks[group_lanes * (9 * a + k) + lane];
      }
  }
  layout_.exchange->add_ghosts(diagonal, 9);
  for (std::size_t n = 0; n < static_cast<std::size_t>(local.owned_nodes); ++n) {
    core::Mat3 block;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const bool fixed = layout_.constrained[3 * n + i] || layout_.constrained[3 * n + j];
        block(i, j) = fixed ? (i == j ? 1.0 : 0.0) : diagonal[9 * n + 3 * i + j];
      }
    const core::Mat3 inverse = block.inverse();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        inverse_diagonal_[9 * n + 3 * i + j] = static_cast<float>(inverse(i, j));
  }
}

void FineLevel::vertex_group(int group, VertexBlock* out) const {
  const std::size_t first = static_cast<std::size_t>(group) * group_lanes;
  const Lanes alpha = load_lanes(&alpha_[first]), beta = load_lanes(&beta_[first]);
  const Lanes inverse_volume = load_lanes(&inverse_volume_[first]);
  Lanes K[4][3][4][3] = {}, mean[4][3] = {};
  for (int q = 0; q < element_points_; ++q) {
    const PointLanes p{point(group, q)};
    const Lanes w = p.volume();
    Lanes g[4][3], E[4][5][3];
    for (int a = 0; a < 4; ++a) {
      const auto& l = mesh::barycentric_gradients[a];
      space_gradient(
          p, {static_cast<float>(l[0]), static_cast<float>(l[1]), static_cast<float>(l[2])}, g[a]);
      node_modes(g[a], E[a]);
    }
    for (int b = 0; b < 4; ++b) {
      Lanes S[5][3];
      stress_of(p, E[b], S);
      for (int a = 0; a <= b; ++a)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            Lanes sum = alpha * w * g[a][i] * g[b][j];
            for (int m = 0; m < 5; ++m) sum += E[a][m][i] * S[m][j];
            K[a][i][b][j] += sum;
          }
      for (int i = 0; i < 3; ++i) mean[b][i] += w * g[b][i];
    }
  }
  const Lanes factor = beta * inverse_volume;
  for (int a = 0; a < 4; ++a)
    for (int b = a; b < 4; ++b)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const Lanes k = K[a][i][b][j] + factor * mean[a][i] * mean[b][j];
          for (int lane = 0; lane < group_lanes; ++lane)
            out[lane][a][i][b][j] = out[lane][b][j][a][i] = k[lane];
        }
}

void FineLevel::forces_of(int group, const float* x, float* f) const {
  const std::size_t first = static_cast<std::size_t>(group) * group_lanes;
  Lanes u[dofs_of_element], forces[dofs_of_element] = {};
  const int* nodes = &nodes_[first * element_nodes];
  for (int a = 0; a < element_nodes; ++a)
    for (int lane = 0; lane < group_lanes; ++lane) {
      const float* at = x + nodes[group_lanes * a + lane];
      for (int i = 0; i < 3; ++i) u[3 * a + i][lane] = at[i];
    }
  Lanes stress[max_element_points][5], divergence[max_element_points], mean{};
  for (int q = 0; q < element_points_; ++q) {
    const PointLanes p{point(group, q)};
    const auto& N = gradients_[q];
    Lanes r[3][3] = {}, h[3][3];
    for (int b = 0; b < element_nodes; ++b)
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L) r[k][L] += N[L][b] * u[3 * b + k];
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        h[k][l] =
            r[k][0] * p.jacobian(0, l) + r[k][1] * p.jacobian(1, l) + r[k][2] * p.jacobian(2, l);
    const Lanes e[5] = {inv_sqrt2 * (h[0][0] - h[1][1]),
                        inv_sqrt6 * (2 * h[2][2] - h[0][0] - h[1][1]),
                        inv_sqrt2 * (h[1][2] + h[2][1]), inv_sqrt2 * (h[2][0] + h[0][2]),
                        inv_sqrt2 * (h[0][1] + h[1][0])};
    for (int m = 0; m < 5; ++m) {
      stress[q][m] = p.modulus(m, 0) * e[0];
      for (int n = 1; n < 5; ++n) stress[q][m] += p.modulus(m, n) * e[n];
    }
    divergence[q] = h[0][0] + h[1][1] + h[2][2];
    mean += p.volume() * divergence[q];
  }
  const Lanes alpha = load_lanes(&alpha_[first]);
  mean *= load_lanes(&beta_[first]) * load_lanes(&inverse_volume_[first]);
  for (int q = 0; q < element_points_; ++q) {
    const PointLanes p{point(group, q)};
    const Lanes* s = stress[q];
    const Lanes c = p.volume() * (alpha * divergence[q] + mean);
    const Lanes a = inv_sqrt2 * s[0], b = inv_sqrt6 * s[1];
    const Lanes yz = inv_sqrt2 * s[2], zx = inv_sqrt2 * s[3], xy = inv_sqrt2 * s[4];
    const Lanes T[3][3] = {{a - b + c, xy, zx}, {xy, c - a - b, yz}, {zx, yz, 2 * b + c}};
    add_forces(p, gradients_[q], T, forces);
  }
  for (int k = 0; k < dofs_of_element; ++k) store_lanes(f + group_lanes * k, forces[k]);
}

void FineLevel::volume_forces_of(int group, const float* c, float* f) const {
  const std::size_t first = static_cast<std::size_t>(group) * group_lanes;
  Lanes push{}, forces[dofs_of_element] = {};
  for (int lane = 0; lane < lanes_of(group); ++lane)
    push[lane] = c[first + lane] * scale_[first + lane];
  for (int q = 0; q < element_points_; ++q) {
    const PointLanes p{point(group, q)};
    const Lanes t = push * p.volume(), zero{};
    const Lanes T[3][3] = {{t, zero, zero}, {zero, t, zero}, {zero, zero, t}};
    add_forces(p, gradients_[q], T, forces);
  }
  for (int k = 0; k < dofs_of_element; ++k) store_lanes(f + group_lanes * k, forces[k]);
}

template <class Forces>
void FineLevel::sum_groups(const Forces& forces) {
  const auto each = [&](int g, const auto& put) {
    alignas(64) float f[dofs_of_element * group_lanes];
    forces(g, f);
    const int lanes = lanes_of(g);
    const int* nodes = &nodes_[static_cast<std::size_t>(g) * group_lanes * element_nodes];
    for (int lane = 0; lane < lanes; ++lane)
      for (int a = 0; a < element_nodes; ++a)
        put(lane, a, nodes[group_lanes * a + lane], f + 3 * group_lanes * a + lane);
  };
  if (threaded_) {
#pragma omp parallel for schedule(static)
    for (int g = 0; g < groups_; ++g) {
      float* out = &forces_[static_cast<std::size_t>(g) * group_lanes * dofs_of_element];
      each(g, [&](int lane, int a, int, const float* f) {
        for (int i = 0; i < 3; ++i) out[dofs_of_element * lane + 3 * a + i] = f[group_lanes * i];
      });
    }
    (*sum_)(forces_, y_.data());
    return;
  }
  std::fill(y_.begin(), y_.end(), 0.0f);
  for (int g = 0; g < groups_; ++g)
    each(g, [&](int, int, int node, const float* f) {
      for (int i = 0; i < 3; ++i) y_[node + i] += f[group_lanes * i];
    });
}

void FineLevel::apply(float* x, float* y) {
  layout_.exchange->update_ghosts(x, 3);
  sum_groups([&](int g, float* f) { forces_of(g, x, f); });
  layout_.exchange->add_ghosts(y_, 3);
  for (std::size_t i = 0; i < dofs(); ++i) y[i] = layout_.constrained[i] ? 0.0f : y_[i];
}

void FineLevel::apply_inverse_diagonal(const float* x, float* y) const {
  const auto n = static_cast<std::size_t>(layout_.local->owned_nodes);
  for (std::size_t k = 0; k < n; ++k) {
    const float* d = &inverse_diagonal_[9 * k];
    const float a = x[3 * k], b = x[3 * k + 1], c = x[3 * k + 2];
    for (std::size_t i = 0; i < 3; ++i)
      y[3 * k + i] = d[3 * i] * a + d[3 * i + 1] * b + d[3 * i + 2] * c;
  }
}

void FineLevel::add_volume_forces(const std::vector<float>& c, const float* x, float* y) {
  sum_groups([&](int g, float* f) { volume_forces_of(g, c.data(), f); });
  layout_.exchange->add_ghosts(y_, 3);
  for (std::size_t i = 0; i < dofs(); ++i) y[i] = layout_.constrained[i] ? 0.0f : x[i] + y_[i];
}

}  // namespace polyslip::solver
