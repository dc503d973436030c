#pragma once
// The test twin of the FCC update: one point, plain loops, spectral logarithm, elastic strain and
// every slip strength as unknowns, Jacobian by differences. Slow on purpose; it shares nothing with
// the kernel but the slip systems.

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/rotation.hpp"
#include "core/tensor.hpp"
#include "material/crystal_law.hpp"
#include "material/slip_systems.hpp"

namespace polyslip::material::test {

/// Of all systems; one component if they share one strength.
using Strengths = Eigen::VectorXd;

struct ReferencePoint {
  core::Quaternion orientation;
  core::Vec5 elastic = core::Vec5::Zero();
  Strengths g;
  double slip = 0, equivalent_strain = 0;
  core::Vec6 stress = core::Vec6::Zero();
  bool converged = false;
};

struct ReferenceSlip {
  core::Mat3 gradient = core::Mat3::Zero();  // sum of Dg s n
  std::vector<double> sizes;                 // |Dg|
  double total = 0;
};

class ReferenceUpdate {
 public:
  explicit ReferenceUpdate(const MaterialOptions& options)
      : o_(options), systems_(fcc_slip_systems()) {}

  core::Vec5 stress5(const core::Vec5& e) const {
    core::Vec5 moduli;
    moduli << o_.c11 - o_.c12, o_.c11 - o_.c12, 2 * o_.c44, 2 * o_.c44, 2 * o_.c44;
    return moduli.cwiseProduct(e);
  }

  ReferenceSlip slip(const core::Vec5& e, const Strengths& g, double dt) const {
    const core::Mat3 s = core::from_deviator5(stress5(e));
    ReferenceSlip result;
    for (std::size_t a = 0; a < systems_.size(); ++a) {
      const auto& system = systems_[a];
      const double tau = system.direction.dot(s * system.normal);
      const double strength = g.size() == 1 ? g[0] : g[static_cast<Eigen::Index>(a)];
      const double dg = dt * o_.reference_slip_rate *
                        std::pow(std::abs(tau / strength), 1 / o_.rate_sensitivity) *
                        (tau < 0 ? -1 : 1);
      result.gradient += dg * system.direction * system.normal.transpose();
      result.sizes.push_back(std::abs(dg));
      result.total += std::abs(dg);
    }
    return result;
  }

  /// g - g_old - h0 ((gs - g)/(gs - g0))^exponent sum_b q_ab |Dg_b|, each, in MPa.
  Strengths strength_residual(const Strengths& g, const Strengths& g_old,
                              const ReferenceSlip& slips) const {
    Strengths r = g - g_old;
    if (o_.h0 == 0 || o_.gs == o_.g0) return r;
    for (Eigen::Index a = 0; a < g.size(); ++a) {
      double hardening = 0;
      for (std::size_t b = 0; b < systems_.size(); ++b) {
        const bool other = g.size() > 1 && static_cast<std::size_t>(a) != b;
        hardening += (other ? o_.latent_ratio : 1.0) * slips.sizes[b];
      }
      r[a] -= o_.h0 * std::pow((o_.gs - g[a]) / (o_.gs - o_.g0), o_.voce_exponent) * hardening;
    }
    return r;
  }

  /// Elastic strain and, over g_scale, strengths.
  Eigen::VectorXd residual(const Eigen::VectorXd& u, const ReferencePoint& old,
                           const core::Mat3& strain, double dt) const {
    const core::Vec5 e = u.head<5>();
    const Strengths g = u.tail(old.g.size()) * g_scale;
    const ReferenceSlip s = slip(e, g, dt);
    const core::Mat3 w = core::skew_part(s.gradient);
    const core::Mat3 seen = strain + 0.5 * (w * strain - strain * w);
    Eigen::VectorXd r(u.size());
    r << e - old.elastic - core::deviator5(seen) + core::deviator5(s.gradient),
        strength_residual(g, old.g, s) / g_scale;
    return r;
  }

  /// `start` and `start_g`: where to look for the solution.
  ReferencePoint update(const ReferencePoint& old, const core::Mat3& f, double dt,
                        const core::Vec5& start, const Strengths& start_g) const {
    const core::Mat3 fbar = f / std::cbrt(f.determinant());
    const Eigen::SelfAdjointEigenSolver<core::Mat3> spectrum(fbar.transpose() * fbar);
    const core::Vec3 c = spectrum.eigenvalues();
    const core::Mat3 v = spectrum.eigenvectors();
    const core::Mat3 log_u = 0.5 * v * c.array().log().matrix().asDiagonal() * v.transpose();
    const core::Mat3 inverse_u = v * c.array().rsqrt().matrix().asDiagonal() * v.transpose();
    const core::Mat3 rotation_old = core::to_matrix(old.orientation);
    const core::Mat3 strain = rotation_old.transpose() * core::deviator(log_u) * rotation_old;

    ReferencePoint result = old;
    Eigen::VectorXd u(5 + old.g.size());
    u << start, start_g / g_scale;
    Eigen::VectorXd r = residual(u, old, strain, dt);
    for (int iteration = 0; iteration < 400 && r.norm() > 1e-13; ++iteration) {
      Eigen::MatrixXd jacobian(u.size(), u.size());
      for (Eigen::Index j = 0; j < u.size(); ++j) {
        Eigen::VectorXd up = u, down = u;
        up[j] += 1e-10;
        down[j] -= 1e-10;
        jacobian.col(j) =
            (residual(up, old, strain, dt) - residual(down, old, strain, dt)) / (up[j] - down[j]);
      }
      const Eigen::VectorXd step = -jacobian.fullPivLu().solve(r);
      double factor = 1;
      Eigen::VectorXd next = residual(u + step, old, strain, dt);
      while (!(next.norm() < r.norm()) && factor > 1e-9) {
        factor /= 2;
        next = residual(u + factor * step, old, strain, dt);
      }
      if (factor <= 1e-9) break;
      u += factor * step;
      r = next;
    }
    result.converged = r.norm() < 1e-11;
    result.elastic = u.head<5>();
    result.g = u.tail(old.g.size()) * g_scale;
    const ReferenceSlip s = slip(result.elastic, result.g, dt);
    result.slip += s.total;
    result.equivalent_strain += core::equivalent_strain(core::symmetric_part(s.gradient));
    const core::Vec3 w = core::axial(s.gradient);
    const core::Mat3 rotation =
        fbar * inverse_u * rotation_old * core::to_matrix(core::exp_axial(-w));
    result.orientation = core::aligned_sign(core::from_matrix(rotation), old.orientation);
    result.stress = core::mandel(rotation * core::from_deviator5(stress5(result.elastic)) *
                                 rotation.transpose());
    return result;
  }

 private:
  static constexpr double g_scale = 1e4;  // MPa; unknowns of the size of elastic strains

  MaterialOptions o_;
  std::vector<SlipSystem> systems_;
};

}  // namespace polyslip::material::test
