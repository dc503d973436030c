#include "solver/predictor.hpp"

#include "core/error.hpp"

namespace polyslip::solver {

Predictor::Predictor(std::size_t displacements, std::size_t pressures)
    : rate_(displacements, 0), previous_rate_(displacements, 0), pressure_rate_(pressures, 0) {}

void Predictor::record(const std::vector<double>& du, const std::vector<double>& dp, double h) {
  previous_rate_ = rate_;
  previous_ = last_;
  last_ = h;
  for (std::size_t i = 0; i < rate_.size(); ++i) rate_[i] = du[i] / h;
  for (std::size_t i = 0; i < pressure_rate_.size(); ++i) pressure_rate_[i] = dp[i] / h;
}

void Predictor::extrapolate(double h, std::vector<double>& x, std::vector<double>& p) const {
  const double slope = previous_ > 0 ? (h + last_) / (last_ + previous_) : 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += h * (rate_[i] + slope * (rate_[i] - previous_rate_[i]));
  for (std::size_t i = 0; i < p.size(); ++i) p[i] += h * pressure_rate_[i];
}

void Predictor::restore(std::vector<double> rate, std::vector<double> previous_rate,
                        std::vector<double> pressure_rate, double last, double previous) {
  if (rate.size() != rate_.size() || previous_rate.size() != previous_rate_.size() ||
      pressure_rate.size() != pressure_rate_.size() || !(last >= 0) || !(previous >= 0))
    throw core::InternalError("Predictor: the stored history does not fit the mesh");
  rate_ = std::move(rate);
  previous_rate_ = std::move(previous_rate);
  pressure_rate_ = std::move(pressure_rate);
  last_ = last;
  previous_ = previous;
}

}  // namespace polyslip::solver
