#include "solver/fgmres.hpp"

#include <algorithm>
#include <cmath>

#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

/// Entries that are summed one after the other.
constexpr std::size_t block = 4096;

double local_dot(const double* a, const double* b, std::size_t n) {
  const auto blocks = static_cast<long>((n + block - 1) / block);
  std::vector<double> sums(static_cast<std::size_t>(blocks), 0.0);
#pragma omp parallel for schedule(static)
  for (long k = 0; k < blocks; ++k) {
    const std::size_t first = static_cast<std::size_t>(k) * block;
    const std::size_t last = std::min(n, first + block);
    double s[8] = {};
    std::size_t i = first;
    for (; i + 8 <= last; i += 8)
      for (std::size_t j = 0; j < 8; ++j) s[j] += a[i + j] * b[i + j];
    for (; i < last; ++i) s[0] += a[i] * b[i];
    sums[static_cast<std::size_t>(k)] =
        ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
  }
  double total = 0;
  for (double s : sums) total += s;
  return total;
}

}  // namespace

double FlexibleGmres::norm(const double* v) const {
  if (profile_) profile_->count_reduction();
  return std::sqrt(sum(comm_, local_dot(v, v, size_)));
}

void FlexibleGmres::release() {
  basis_.clear();
  directions_.clear();
}

std::vector<double> FlexibleGmres::dots(int count, const double* w) const {
  std::vector<double> out(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = local_dot(basis_[k].data(), w, size_);
  if (profile_) profile_->count_reduction();
  sum(comm_, out.data(), count);
  return out;
}

void FlexibleGmres::subtract(const std::vector<double>& coefficients, double* w) const {
#pragma omp parallel for schedule(static)
  for (std::size_t first = 0; first < size_; first += block)
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      const double c = coefficients[k], *v = basis_[k].data();
      for (std::size_t i = first; i < std::min(size_, first + block); ++i) w[i] -= c * v[i];
    }
}

double* FlexibleGmres::first() {
  if (basis_.empty()) basis_.emplace_back(size_);
  return basis_[0].data();
}

FlexibleGmres::Report FlexibleGmres::solve(const Operator& A, const Preconditioner& M,
                                           const double* b, double* x, double tolerance,
                                           int max_iterations) {
  std::fill(x, x + size_, 0.0);
  std::copy_n(b, size_, first());
  Report report;
  report.start = norm(b);
  iterate(A, M, x, tolerance * report.start, max_iterations, report);
  return report;
}

FlexibleGmres::Report FlexibleGmres::improve(const Operator& A, const Preconditioner& M,
                                             const double* b, double* x, double tolerance,
                                             int max_iterations) {
  double* r = first();
  A(x, r);
  for (std::size_t i = 0; i < size_; ++i) r[i] = b[i] - r[i];
  Report report;
  report.start = norm(r);
  iterate(A, M, x, tolerance * norm(b), max_iterations, report);
  return report;
}

void FlexibleGmres::iterate(const Operator& A, const Preconditioner& M, double* x, double wanted,
                            int max_iterations, Report& report) {
  const double start = report.start;
  report.residual = start;
  report.converged = start <= wanted;
  if (report.converged || !std::isfinite(start)) return;
  const auto vector_of = [&](auto& vectors, std::size_t k) {
    if (vectors.size() <= k) vectors.emplace_back(size_);
    return vectors[k].data();
  };
  for (double& r : basis_[0]) r /= start;
  // Hessenberg matrix by columns, made triangular by rotations (c, s); g: the right side.
  std::vector<std::vector<double>> H;
  std::vector<double> c, s, g{start};
  std::vector<double> z(size_);
  while (report.iterations < max_iterations && !report.converged) {
    const auto j = static_cast<std::size_t>(report.iterations);
    double* w = vector_of(basis_, j + 1);
    float* direction = vector_of(directions_, j);
    M(basis_[j].data(), direction);
    std::copy_n(direction, size_, z.begin());
    A(z.data(), w);
    const Stage stage(profile_, "orthogonalisation");
    std::vector<double> h = dots(static_cast<int>(j) + 1, w);
    double before = 0;
    for (double value : h) before += value * value;
    subtract(h, w);
    double length = norm(w);
    // Classical Gram-Schmidt loses digits where little is left: once more (Daniel and others,
    // Math. Comp. 30, 1976).
    if (!(length * length > 0.5 * before)) {
      const std::vector<double> more = dots(static_cast<int>(j) + 1, w);
      subtract(more, w);
      for (std::size_t k = 0; k < more.size(); ++k) h[k] += more[k];
      length = norm(w);
    }
    ++report.iterations;
    if (!std::isfinite(length)) {
      report.residual = std::nan("");
      break;
    }
    if (length > 0)
      for (std::size_t i = 0; i < size_; ++i) w[i] /= length;
    for (std::size_t k = 0; k < j; ++k) {
      const double t = c[k] * h[k] + s[k] * h[k + 1];
      h[k + 1] = c[k] * h[k + 1] - s[k] * h[k];
      h[k] = t;
    }
    const double radius = std::hypot(h[j], length);
    c.push_back(radius > 0 ? h[j] / radius : 1);
    s.push_back(radius > 0 ? length / radius : 0);
    h[j] = radius;
    H.push_back(h);
    g.push_back(-s[j] * g[j]);
    g[j] *= c[j];
    report.residual = std::abs(g[j + 1]);
    report.converged = report.residual <= wanted;
    if (radius == 0 || length == 0) break;
  }
  for (std::size_t k = H.size(); k-- > 0;) {
    for (std::size_t l = k + 1; l < H.size(); ++l) g[k] -= H[l][k] * g[l];
    g[k] = H[k][k] != 0 ? g[k] / H[k][k] : 0;
  }
#pragma omp parallel for schedule(static)
  for (std::size_t begin = 0; begin < size_; begin += block)
    for (std::size_t k = 0; k < H.size(); ++k)
      for (std::size_t i = begin; i < std::min(size_, begin + block); ++i)
        x[i] += g[k] * static_cast<double>(directions_[k][i]);
}

}  // namespace polyslip::solver
