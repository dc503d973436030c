#pragma once
// Random material points and one call of a law on them.

#include <gtest/gtest.h>

#include <vector>

#include "core/random.hpp"
#include "core/tensor.hpp"
#include "material/crystal_law.hpp"

namespace polyslip::material::test {

inline std::size_t lane_index(int point, int component, int components) {
  return static_cast<std::size_t>((point / lanes * components + component) * lanes + point % lanes);
}

/// Arrays of a call of CrystalLaw::update; a multiple of four points.
struct Batch {
  int points, components;
  int strength, strengths;  // first component of "g", how many: 1 or 12
  int slip, equivalent_strain;
  double time_step = 0.01;
  std::vector<double> gradient, old, fresh, stress, tangent;
  std::vector<PointStatus> status;

  Batch(const CrystalLaw& law, int n)
      : points(n),
        components(law.layout().size()),
        strength(law.layout().offset("g")),
        strengths(law.layout().offset("slip") - strength),
        slip(strength + strengths),
        equivalent_strain(law.layout().offset("equivalent_strain")),
        gradient(static_cast<std::size_t>(9 * n)),
        old(static_cast<std::size_t>(components * n)),
        fresh(old.size(), std::nan("")),
        stress(static_cast<std::size_t>(6 * n), std::nan("")),
        tangent(static_cast<std::size_t>(54 * n), std::nan("")),
        status(static_cast<std::size_t>(n), PointStatus::not_converged) {
    for (int p = 0; p < n; ++p) set_state(law, p, core::Quaternion::Identity());
    for (int p = 0; p < n; ++p) set_gradient(p, core::Mat3::Identity());
  }

  void set_state(const CrystalLaw& law, int point, const core::Quaternion& q) {
    std::vector<double> state(static_cast<std::size_t>(components));
    law.initial_state(q, state.data());
    for (int i = 0; i < components; ++i) {
      old[lane_index(point, i, components)] = state[static_cast<std::size_t>(i)];
    }
  }
  void set_gradient(int point, const core::Mat3& f) {
    for (int i = 0; i < 9; ++i) gradient[lane_index(point, i, 9)] = f(i / 3, i % 3);
  }
  core::Mat3 gradient_of(int point) const {
    core::Mat3 f;
    for (int i = 0; i < 9; ++i) f(i / 3, i % 3) = gradient[lane_index(point, i, 9)];
    return f;
  }
  double& old_state(int point, int component) {
    return old[lane_index(point, component, components)];
  }
  double new_state(int point, int component) const {
    return fresh[lane_index(point, component, components)];
  }
  core::Vec6 stress_of(int point) const {
    core::Vec6 s;
    for (int i = 0; i < 6; ++i) s[i] = stress[lane_index(point, i, 6)];
    return s;
  }
  core::Quaternion orientation_of(int point) const {
    return {new_state(point, 0), new_state(point, 1), new_state(point, 2), new_state(point, 3)};
  }
  void run(const CrystalLaw& law, bool with_tangent = true) {
    PointBlocks blocks;
    blocks.n_blocks = points / lanes;
    blocks.time_step = time_step;
    blocks.relative_gradient = gradient.data();
    blocks.state_old = old.data();
    blocks.state_new = fresh.data();
    blocks.stress = stress.data();
    blocks.tangent = with_tangent ? tangent.data() : nullptr;
    blocks.status = status.data();
    law.update(blocks);
  }
  int failures() const {
    int n = 0;
    for (const auto s : status) n += s == PointStatus::converged ? 0 : 1;
    return n;
  }
};

inline core::Mat3 random_matrix(core::Random& random) {
  core::Mat3 a;
  for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = random.normal();
  return a;
}

/// Elastic strain whose largest |tau/g| is about `level` (12 MPa at most), random direction.
inline core::Vec5 random_elastic(core::Random& random, const MaterialOptions& o, double level) {
  core::Vec5 s;
  for (int i = 0; i < 5; ++i) s[i] = random.normal();
  s *= level * 1.7 * o.g0 / s.norm();
  core::Vec5 e;
  for (int i = 0; i < 5; ++i) e[i] = s[i] / (i < 2 ? o.c11 - o.c12 : 2 * o.c44);
  return e;
}

/// Fills a batch with random orientations, elastic strains from zero to beyond flow, strengths
/// between g0 and gs, and deformations whose size spreads over `smallest` to `largest`.
inline void randomise(Batch& batch, const CrystalLaw& law, const MaterialOptions& o,
                      core::Random& random, double smallest, double largest) {
  for (int p = 0; p < batch.points; ++p) {
    batch.set_state(law, p, random.rotation());
    const double level = p % 4 == 0 ? 0.0 : random.uniform(0.0, 1.3);
    const core::Vec5 e = random_elastic(random, o, level);
    for (int i = 0; i < 5; ++i) batch.old_state(p, 4 + i) = e[i];
    for (int a = 0; a < batch.strengths; ++a) {
      batch.old_state(p, batch.strength + a) = random.uniform(o.g0, o.gs);
    }
    const double size = smallest * std::pow(largest / smallest, random.uniform());
    const core::Mat3 a = random_matrix(random);
    batch.set_gradient(p, core::Mat3::Identity() + size / a.norm() * a);
  }
}

}  // namespace polyslip::material::test
