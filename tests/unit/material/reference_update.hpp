#pragma once
// The test twin of the FCC update: one point, plain loops, spectral logarithm, Jacobian by
// differences. Slow on purpose; it shares nothing with the kernel but the slip systems.

#include <Eigen/Dense>
#include <cmath>

#include "core/rotation.hpp"
#include "core/tensor.hpp"
#include "material/crystal_law.hpp"
#include "material/slip_systems.hpp"

namespace polyslip::material::test {

struct ReferencePoint {
  core::Quaternion orientation;
  core::Vec5 elastic = core::Vec5::Zero();
  double g = 0, slip = 0, equivalent_strain = 0;
  core::Vec6 stress = core::Vec6::Zero();
  bool converged = false;
};

struct ReferenceSlip {
  core::Mat3 gradient = core::Mat3::Zero();  // sum of Dg s n
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

  ReferenceSlip slip(const core::Vec5& e, double g, double dt) const {
    const core::Mat3 s = core::from_deviator5(stress5(e));
    ReferenceSlip result;
    for (const auto& system : systems_) {
      const double tau = system.direction.dot(s * system.normal);
      const double dg = dt * o_.reference_slip_rate *
                        std::pow(std::abs(tau / g), 1 / o_.rate_sensitivity) * (tau < 0 ? -1 : 1);
      result.gradient += dg * system.direction * system.normal.transpose();
      result.total += std::abs(dg);
    }
    return result;
  }

  /// Voce's law by bisection on g.
  double strength(const core::Vec5& e, double g_old, double dt) const {
    if (o_.h0 == 0 || o_.gs == o_.g0) return g_old;
    double low = g_old, high = o_.gs;
    for (int i = 0; i < 200; ++i) {
      const double g = 0.5 * (low + high);
      const double total = slip(e, g, dt).total;
      const double excess = g - g_old - o_.h0 * (o_.gs - g) / (o_.gs - o_.g0) * total;
      (excess < 0 ? low : high) = g;
    }
    return 0.5 * (low + high);
  }

  core::Vec5 residual(const core::Vec5& e, const ReferencePoint& old, const core::Mat3& strain,
                      double dt) const {
    const ReferenceSlip s = slip(e, strength(e, old.g, dt), dt);
    const core::Mat3 w = core::skew_part(s.gradient);
    const core::Mat3 seen = strain + 0.5 * (w * strain - strain * w);
    return e - old.elastic - core::deviator5(seen) + core::deviator5(s.gradient);
  }

  ReferencePoint update(const ReferencePoint& old, const core::Mat3& f, double dt,
                        core::Vec5 start) const {
    const core::Mat3 fbar = f / std::cbrt(f.determinant());
    const Eigen::SelfAdjointEigenSolver<core::Mat3> spectrum(fbar.transpose() * fbar);
    const core::Vec3 c = spectrum.eigenvalues();
    const core::Mat3 v = spectrum.eigenvectors();
    const core::Mat3 log_u = 0.5 * v * c.array().log().matrix().asDiagonal() * v.transpose();
    const core::Mat3 inverse_u = v * c.array().rsqrt().matrix().asDiagonal() * v.transpose();
    const core::Mat3 rotation_old = core::to_matrix(old.orientation);
    const core::Mat3 strain = rotation_old.transpose() * core::deviator(log_u) * rotation_old;

    ReferencePoint result = old;
    core::Vec5 e = start;
    core::Vec5 r = residual(e, old, strain, dt);
    for (int iteration = 0; iteration < 400 && r.norm() > 1e-13; ++iteration) {
      core::Mat5 jacobian;
      for (int j = 0; j < 5; ++j) {
        const double h = 1e-10;
        jacobian.col(j) = (residual(e + h * core::Vec5::Unit(j), old, strain, dt) -
                           residual(e - h * core::Vec5::Unit(j), old, strain, dt)) /
                          (2 * h);
      }
      const core::Vec5 step = -jacobian.fullPivLu().solve(r);
      double factor = 1;
      core::Vec5 next = residual(e + step, old, strain, dt);
      while (!(next.norm() < r.norm()) && factor > 1e-9) {
        factor /= 2;
        next = residual(e + factor * step, old, strain, dt);
      }
      e += factor * step;
      r = next;
      if (factor <= 1e-9) break;
    }
    result.converged = r.norm() < 1e-11;
    result.elastic = e;
    result.g = strength(e, old.g, dt);
    const ReferenceSlip s = slip(e, result.g, dt);
    result.slip += s.total;
    result.equivalent_strain += core::equivalent_strain(core::symmetric_part(s.gradient));
    const core::Vec3 w = core::axial(s.gradient);
    const core::Mat3 rotation =
        fbar * inverse_u * rotation_old * core::to_matrix(core::exp_axial(-w));
    result.orientation = core::aligned_sign(core::from_matrix(rotation), old.orientation);
    result.stress =
        core::mandel(rotation * core::from_deviator5(stress5(e)) * rotation.transpose());
    return result;
  }

 private:
  MaterialOptions o_;
  std::vector<SlipSystem> systems_;
};

}  // namespace polyslip::material::test
