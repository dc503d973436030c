#pragma once
// What a deck asks for in [loading] and [solver].

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace polyslip::solver {

/// What type = "faces" does to one face of the box.
struct FaceCondition {
  /// "free"; "sliding": flat, normal velocity given, no shear; "fixed"; "moving": every component
  /// of the velocity given; "planar": stays flat, mean normal traction given, no shear
  std::string kind = "free";
  core::Vec3 velocity = core::Vec3::Zero();  ///< L/s at the reference strain rate
  double traction = 0;                       ///< MPa, pulls if positive
};

/// A corner node of the box that is held in some components, under type = "faces".
struct HeldCorner {
  std::array<int, 3> sides{};  ///< 0: low, 1: high, along x y z
  std::array<bool, 3> components{};
};

/// A part of the load at one rate; it ends at the first of its targets that is reached.
struct LoadingStage {
  double strain_rate = 1.0;      ///< 1/s; negative: backwards (a strain target fixes the sign)
  std::optional<double> strain;  ///< load strain at the end
  std::optional<double> time;    ///< s, of the run, at the end
  std::optional<double> stress;  ///< MPa, load stress at the end
};

struct LoadingOptions {
  std::string type = "plane-strain-compression";
  std::string control = "true-strain-rate";  ///< or "constant-velocity"
  std::string lateral = "symmetry";          ///< or "planar", "free"
  int axis = 2;              ///< of compression or tension; normal of the plane of simple shear
  int constrained_axis = 1;  ///< of plane strain
  int direction = 0;         ///< of simple shear
  core::Mat3 velocity_gradient = core::Mat3::Zero();  ///< its shape counts
  std::array<FaceCondition, 6> faces{};               ///< x0 x1 y0 y1 z0 z1
  std::vector<HeldCorner> held;
  double traction_strain = 0.005;                  ///< over which mean tractions grow from zero
  double strain_rate = 1.0;                        ///< 1/s
  double final_strain = 0.6;                       ///< of the load (solver/load_program.hpp)
  std::optional<double> final_time, final_stress;  ///< s, MPa
  std::vector<LoadingStage> stages;                ///< if not empty: instead of rate and final_...
  double max_strain_increment = 0.02;
  double initial_strain_increment = 2e-4;  ///< first step from zero stress or of a stage
  double increment_growth = 1.6;           ///< factor from step to step
  double min_strain_increment = 1e-7;      ///< below: the run stops with a restartable state
  bool fixed_increment = false;            ///< every step max_strain_increment (cut to hit targets)
};

struct SolverOptions {
  std::string element =
      "mixed";                ///< "mixed" (T10/P0), "displacement" or its "displacement-straight"
  int quadrature_points = 4;  ///< of an element: 4, 8, 14 or 15
  double newton_tolerance = 1e-3;
  double velocity_tolerance = 1e-3;
  int max_newton_iterations = 20;
  double linear_tolerance = 1e-2;
  int max_linear_iterations = 200;
};

}  // namespace polyslip::solver
