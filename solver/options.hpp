#pragma once
// What a deck asks for in [loading] and [solver].

#include <string>

namespace polyslip::solver {

struct LoadingOptions {
  std::string type = "plane-strain-compression";
  double strain_rate = 1.0;   ///< 1/s, true strain rate
  double final_strain = 0.6;  ///< ln(h0/h)
  double max_strain_increment = 0.02;
  double initial_strain_increment = 2e-4;  ///< first step from zero stress
  double increment_growth = 1.6;           ///< factor from step to step
  double min_strain_increment = 1e-7;      ///< below: the run stops with a restartable state
  bool fixed_increment = false;            ///< every step max_strain_increment (cut to hit targets)
};

struct SolverOptions {
  std::string element = "mixed";  ///< "mixed" (T10/P0) or "displacement"; deck: mixed only
  double newton_tolerance = 1e-3;
  int max_newton_iterations = 20;
  double linear_tolerance = 1e-2;
  int max_linear_iterations = 200;
};

}  // namespace polyslip::solver
