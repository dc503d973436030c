#include "solver/multigrid.hpp"

#include <algorithm>
#include <cmath>

#include "solver/exchange.hpp"

namespace polyslip::solver {

Multigrid::Multigrid(const LinearLayout& layout, const Settings& settings)
    : settings_(settings),
      fine_(layout),
      vertices_(layout),
      smoother_(fine_, settings.smoother),
      coarse_(settings.coarse),
      x_(fine_.local_dofs()),
      residual_(settings.sweeps_before > 0 ? fine_.dofs() : 0),
      correction_(fine_.dofs()),
      coarse_rhs_(vertices_.coordinates().size()),
      coarse_solution_(coarse_rhs_.size()) {}

bool Multigrid::serves(const std::vector<float>& scales, double kept_change) const {
  double sums[2] = {0, static_cast<double>(scales.size())};
  const bool none = scales_.size() != scales.size();
  for (std::size_t n = 0; n < scales.size() && !none; ++n) {
    const double change = std::log(scales[n] / scales_[n]);
    sums[0] += change * change;
  }
  sum(fine_.layout().exchange->comm(), sums, 2);
  const bool any = maximum(fine_.layout().exchange->comm(), none ? 1 : 0) == 0;
  return any && sums[0] < kept_change * kept_change * sums[1];
}

void Multigrid::renew_below(double kept_change) {
  std::vector<float> scales;
  const std::vector<float>& inverse = fine_.inverse_diagonal();
  for (std::size_t k = 0; k < inverse.size(); k += 9)
    scales.push_back(inverse[k] + inverse[k + 4] + inverse[k + 8]);
  if (serves(scales, kept_change)) return;
  scales_ = std::move(scales);
  smoother_.estimate();
  Mat below = vertices_.galerkin(fine_);
  const Stage stage(fine_.layout().exchange->profile(), "aggregation");
  coarse_.set_matrix(below, vertices_.coordinates());
}

void Multigrid::apply(const float* b, float* x) {
  const float* r = b;
  smoother_.smooth(b, x_.data(), settings_.sweeps_before, true);
  if (settings_.sweeps_before > 0) {
    fine_.apply(x_.data(), residual_.data());
    for (std::size_t i = 0; i < residual_.size(); ++i) residual_[i] = b[i] - residual_[i];
    r = residual_.data();
  }
  {
    const Stage stage(fine_.layout().exchange->profile(), "vertex level");
    vertices_.restrict_to(r, coarse_rhs_.data());
    coarse_.solve(coarse_rhs_.data(), coarse_solution_.data());
    vertices_.prolong(coarse_solution_.data(), correction_.data());
    for (std::size_t i = 0; i < correction_.size(); ++i) x_[i] += correction_[i];
  }
  smoother_.smooth(b, x_.data(), settings_.sweeps_after, false);
  std::copy_n(x_.begin(), correction_.size(), x);
}

}  // namespace polyslip::solver
