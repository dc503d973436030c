#pragma once
// Where the next step's Newton iteration starts.

#include <vector>

namespace polyslip::solver {

/// Extrapolates the departure u of the nodes from the homogeneous motion, and the mean stresses p.
/// With rates per unit strain at the middle of the last two steps (of size h1 before h2),
///   du = h [r2 + (r2 - r1) (h + h2)/(h2 + h1)],   dp = h dp2/h2
/// for a step of size h; r2 alone after one step, nothing before.
class Predictor {
 public:
  /// Sizes of the two arrays.
  Predictor(std::size_t displacements, std::size_t pressures);

  /// A step of size h was accepted; departures du and changes dp in it.
  void record(const std::vector<double>& du, const std::vector<double>& dp, double h);
  /// Adds the expected departures of a step of size h to x, changes to p.
  void extrapolate(double h, std::vector<double>& x, std::vector<double>& p) const;

  // What a checkpoint holds.
  const std::vector<double>& rate() const { return rate_; }
  const std::vector<double>& previous_rate() const { return previous_rate_; }
  const std::vector<double>& pressure_rate() const { return pressure_rate_; }
  /// {h2, h1}; zero: no such step
  std::vector<double> steps() const { return {last_, previous_}; }
  void restore(std::vector<double> rate, std::vector<double> previous_rate,
               std::vector<double> pressure_rate, double last, double previous);

 private:
  std::vector<double> rate_, previous_rate_;  // per unit strain
  std::vector<double> pressure_rate_;         // MPa per unit strain
  double last_ = 0, previous_ = 0;
};

}  // namespace polyslip::solver
