#pragma once
// A small-strain isotropic elastic law for tests of elements and solver: no crystal, no rate.

#include <cmath>

#include "material/crystal_law.hpp"

namespace polyslip::tests {

/// sigma' = 2 mu dev(e), e_{n+1} = e_n + sym(f) - 1; for small strains and rotations. A point fails
/// when a component of its strain increment exceeds `failing_increment`.
class ElasticLaw final : public material::CrystalLaw {
 public:
  ElasticLaw(double mu, double bulk, double failing_increment = 1e300)
      : mu_(mu), bulk_(bulk), failing_increment_(failing_increment) {
    layout_.fields = {{"elastic_strain", 6, "1", core::Transport::reset_to_zero, "Mandel"}};
  }
  const core::StateLayout& layout() const override { return layout_; }
  double bulk_modulus() const override { return bulk_; }
  double shear_modulus() const override { return mu_; }
  void initial_state(const core::Quaternion&, double* state) const override {
    for (int i = 0; i < 6; ++i) state[i] = 0;
  }

  void update(const material::PointBlocks& blocks) const override {
    constexpr int lanes = material::lanes;
    for (int b = 0; b < blocks.n_blocks; ++b)
      for (int q = 0; q < lanes; ++q) {
        const auto at = [&](int components, int i) { return (b * components + i) * lanes + q; };
        const auto f = [&](int i, int j) { return blocks.relative_gradient[at(9, 3 * i + j)]; };
        double strain[6];
        auto status = material::PointStatus::converged;
        for (int m = 0; m < 6; ++m) {
          const auto [i, j] = pair(m);
          const double increment = 0.5 * (f(i, j) + f(j, i)) - (i == j ? 1 : 0);
          if (std::abs(increment) > failing_increment_)
            status = material::PointStatus::not_converged;
          strain[m] = blocks.state_old[at(6, m)] + factor(m) * increment;
          blocks.state_new[at(6, m)] = strain[m];
        }
        blocks.status[b * lanes + q] = status;
        const double mean = (strain[0] + strain[1] + strain[2]) / 3;
        for (int m = 0; m < 6; ++m)
          blocks.stress[at(6, m)] = 2 * mu_ * (strain[m] - (m < 3 ? mean : 0));
        if (!blocks.tangent) continue;
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
            for (int m = 0; m < 6; ++m) {
              // d f = E_kl f: row k of f changes by row l.
              const auto df = [&](int i, int j) { return i == k ? f(l, j) : 0.0; };
              const auto [i, j] = pair(m);
              const double sym = 0.5 * (df(i, j) + df(j, i)) * factor(m);
              const double trace = m < 3 ? f(l, k) / 3 : 0;
              blocks.tangent[at(54, 9 * m + 3 * k + l)] = 2 * mu_ * (sym - trace);
            }
      }
  }

 private:
  static std::array<int, 2> pair(int m) {
    constexpr std::array<std::array<int, 2>, 6> pairs{
        {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}}};
    return pairs[static_cast<std::size_t>(m)];
  }
  static double factor(int m) { return m < 3 ? 1 : std::sqrt(2.0); }

  core::StateLayout layout_;
  double mu_, bulk_, failing_increment_;
};

}  // namespace polyslip::tests
