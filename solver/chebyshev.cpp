#include "solver/chebyshev.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.hpp"
#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

/// A number in [-1, 1) that depends on the index only (mixing function of SplitMix64: Steele, Lea,
/// Flood, OOPSLA 2014).
double noise(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

/// Largest eigenvalue of the Lanczos matrix of conjugate gradients with these coefficients, by
/// bisection on the signs of the pivots of T - lambda.
double largest_of(const std::vector<double>& alpha, const std::vector<double>& beta) {
  const std::size_t n = alpha.size();
  std::vector<double> diagonal(n), squares(n, 0.0);  // squares[j]: of the entry (j - 1, j)
  double high = 0;
  for (std::size_t j = 0; j < n; ++j) {
    diagonal[j] = 1 / alpha[j] + (j > 0 ? beta[j - 1] / alpha[j - 1] : 0);
    if (j > 0) squares[j] = beta[j - 1] / (alpha[j - 1] * alpha[j - 1]);
  }
  for (std::size_t j = 0; j < n; ++j)
    high = std::max(
        high, diagonal[j] + std::sqrt(squares[j]) + (j + 1 < n ? std::sqrt(squares[j + 1]) : 0.0));
  const auto above_all = [&](double lambda) {
    double pivot = 1;
    for (std::size_t j = 0; j < n; ++j) {
      pivot = diagonal[j] - lambda - squares[j] / pivot;
      if (!(pivot < 0)) return false;
    }
    return true;
  };
  double low = 0;
  for (int i = 0; i < 40; ++i) (above_all(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  return high;
}

}  // namespace

Chebyshev::Chebyshev(FineLevel& level, const Settings& settings)
    : level_(level),
      settings_(settings),
      residual_(level.dofs()),
      product_(level.dofs()),
      direction_(level.local_dofs()) {}

double Chebyshev::dot(const std::vector<float>& a, const std::vector<float>& b) const {
  double s = 0;
  for (std::size_t i = 0; i < residual_.size(); ++i) s += static_cast<double>(a[i]) * b[i];
  return sum(level_.layout().exchange->comm(), s);
}

void Chebyshev::estimate() {
  const Stage stage(level_.layout().exchange->profile(), "eigenvalue");
  const LinearLayout& layout = level_.layout();
  const auto first = 3 * static_cast<std::uint64_t>(layout.local->first_node);
  std::vector<float> z(level_.dofs());
  for (std::size_t i = 0; i < residual_.size(); ++i)
    residual_[i] = layout.constrained[i] ? 0.0f : static_cast<float>(noise(first + i));
  level_.apply_inverse_diagonal(residual_.data(), z.data());
  std::copy(z.begin(), z.end(), direction_.begin());
  double rz = dot(residual_, z);
  std::vector<double> alpha, beta;
  for (int step = 0; step < settings_.steps && rz > 0; ++step) {
    level_.apply(direction_.data(), product_.data());
    const double curvature = dot(product_, direction_);
    if (!(curvature > 0)) break;
    alpha.push_back(rz / curvature);
    const auto a = static_cast<float>(alpha.back());
    for (std::size_t i = 0; i < residual_.size(); ++i) residual_[i] -= a * product_[i];
    level_.apply_inverse_diagonal(residual_.data(), z.data());
    const double next = dot(residual_, z);
    beta.push_back(next / rz);
    rz = next;
    const auto b = static_cast<float>(beta.back());
    for (std::size_t i = 0; i < residual_.size(); ++i) direction_[i] = z[i] + b * direction_[i];
  }
  // A body without a free dof: any interval will do.
  largest_ = settings_.safety * (alpha.empty() ? 1.0 : largest_of(alpha, beta));
  if (!(largest_ > 0)) throw core::InternalError("Chebyshev: no positive eigenvalue was found");
}

void Chebyshev::smooth(const float* b, float* x, int sweeps, bool zero_guess) {
  const Stage stage(level_.layout().exchange->profile(), "smoother");
  const std::size_t n = level_.dofs();
  if (zero_guess) std::fill(x, x + level_.local_dofs(), 0.0f);
  if (sweeps == 0) return;
  const double centre = 0.5 * largest_ * (1 + settings_.lower);
  const double half_width = 0.5 * largest_ * (1 - settings_.lower);
  const double sigma = centre / half_width;
  const std::vector<float>& inverse = level_.inverse_diagonal();
  if (!zero_guess) level_.apply(x, product_.data());
  double rho = 1 / sigma;
  // r -= A d (at first r = b - A x), d = keep d + gain D^-1 r, x += d, in one pass over the nodes.
  for (int sweep = 1; sweep <= sweeps; ++sweep) {
    const double next = 1 / (2 * sigma - rho);
    const auto gain = static_cast<float>(sweep == 1 ? 1 / centre : 2 * next / half_width);
    const auto keep = static_cast<float>(sweep == 1 ? 0 : next * rho);
    if (sweep > 1) {
      rho = next;
      level_.apply(direction_.data(), product_.data());
    }
    const bool first = sweep == 1;
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < n; k += 3) {
      float r[3];
      for (std::size_t i = 0; i < 3; ++i) {
        r[i] = first ? b[k + i] : residual_[k + i];
        if (!(first && zero_guess)) r[i] -= product_[k + i];
        residual_[k + i] = r[i];
      }
      const float* d = &inverse[3 * k];
      for (std::size_t i = 0; i < 3; ++i) {
        const float z = d[3 * i] * r[0] + d[3 * i + 1] * r[1] + d[3 * i + 2] * r[2];
        const float step = (first ? 0.0f : keep * direction_[k + i]) + gain * z;
        direction_[k + i] = step;
        x[k + i] += step;
      }
    }
  }
}

}  // namespace polyslip::solver
