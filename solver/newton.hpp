#pragma once
// Equilibrium at the end of one step.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solver/boundary.hpp"
#include "solver/discretisation.hpp"
#include "solver/linear_solver.hpp"
#include "solver/options.hpp"
#include "solver/planar_faces.hpp"
#include "solver/reactions.hpp"

namespace polyslip::solver {

/// One step to solve.
struct NewtonProblem {
  const Configuration& old;     ///< last converged one
  double time_step = 0;         ///< s
  double strain_increment = 0;  ///< scale of the volume criterion
  double kappa = 0;             ///< MPa, solver/point_volumes.hpp
  double path = 0;              ///< of the load at the end of the step, for mean tractions
  /// [local_nodes][3] forces of the surroundings on free dofs; empty: none
  std::vector<double> external_forces;
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0;
  int linear_iterations = 0;
  int line_searches = 0;  ///< iterations that took less than the full increment
  std::string reason;     ///< why not; empty if converged
  Balance balance;
};

/// Newton's method on forces and volumes. Converged means, with t = newton_tolerance and F the
/// largest face force,
///   rms(r_free) <= t rms(reactions), root mean squares over the free and over the prescribed dofs,
///   |sum r_free| <= t F and |sum x_i r_free_i| <= t F L for each direction (L = V^(1/3)),
///   the same force on each planar face but for its mean traction,
///   rms over the volume of ln(V/V0) - p/K <= t |strain increment|,
///   |last increment of Newton|_2 <= velocity_tolerance |displacement in the step|_2, which a
///   predictor that meets all others is not asked for,
/// every point converged, no element inverted. The linear systems are solved as well as pays: see
/// `forcing`. Scales never fall below those of a stress of 1e-6
/// times the shear modulus.
class NewtonSolver {
 public:
  /// Collective.
  NewtonSolver(Discretisation& discretisation, const Boundary& boundary,
               const SolverOptions& options, const std::vector<double>& x);

  /// x, p: the predictor on entry (prescribed dofs exact), the solution on return. On success the
  /// discretisation holds the evaluation at the solution. Collective; the same report on each rank.
  NewtonReport solve(const NewtonProblem& problem, std::vector<double>& x, std::vector<double>& p);
  /// Starts the linear solver anew at positions x, as a restart does. Collective.
  void drop_setup(const std::vector<double>& x);

  /// Dofs that are no unknowns of their own, those of planar faces among them.
  const std::vector<std::uint8_t>& constrained() const { return constrained_; }
  const PlanarFaces& planar() const { return planar_; }

 private:
  /// Of the body to a unit motion of a planar face, as the linearised equations have it.
  struct Response {
    std::vector<double> u, p;  // [local_nodes][3] the face's motion included, [elements]
    double share = 0;  // of what the motion of the face alone throws out of balance, the first
                       // guess's
    double asked = 0, left = 0;  // norms of that share, of the rest
  };

  Discretisation& discretisation_;
  const Boundary& boundary_;
  SolverOptions options_;
  std::vector<std::uint8_t> constrained_;
  PlanarFaces planar_;
  std::unique_ptr<LinearSolver> linear_;
  VecHandle ru_, rp_, du_, dp_;
  std::vector<double> residual_;  // [local_nodes][3] internal - external
  std::vector<double> increment_, pressure_increment_;
  std::vector<double> planar_residual_, planar_increment_;  // of each planar face
  std::vector<Response> responses_;                         // to each planar face; empty: none yet
  double length_ = 0, floor_force_ = 0;
  double moved_ = 0;  // |last increment| / |displacement in the step|; 0 before the first

  void update_residual(const NewtonProblem& problem, const std::vector<double>& x);
  Balance measure(const std::vector<double>& x) const;
  /// The criteria on forces alone.
  bool balanced(const Balance& balance) const;
  bool converged(const Balance& balance, const NewtonProblem& problem) const;
  /// What the norm of the free forces may be.
  double allowed(const Balance& balance) const;
  /// The norm of the free forces relative to that.
  double excess(const Balance& balance) const;
  /// Tolerance of the next linear solve, `gain` being what the last iteration made of the forces
  /// (1 before the first).
  double forcing(const Balance& balance, double gain) const;
  /// x: positions.
  bool solve_linear(double tolerance, const std::vector<double>& x, NewtonReport& report);
  /// Solves for increments with these right sides: forces on free dofs, volumes of elements; from
  /// u and p as a guess unless they are empty.
  bool solve_system(double tolerance, const std::vector<double>& forces,
                    const std::vector<double>& volumes, std::vector<double>& u,
                    std::vector<double>& p, LinearReport& linear, NewtonReport& report);
  /// Adds to the increment what the planar faces' own unknowns do; they leave no more than `left`
  /// out of balance (norm of the linear solver).
  bool add_planar(double left, const std::vector<double>& x, NewtonReport& report);
  /// Brings a response up to date with the present tangent: its rest within tolerance * asked.
  bool respond(std::size_t face, double tolerance, const std::vector<double>& x,
               NewtonReport& report);
  /// Force on each planar face (and elements' volumes) by the tangent's action.
  std::vector<double> face_forces(const std::vector<double>& u, const std::vector<double>& p,
                                  std::vector<double>& forces, std::vector<double>& volumes) const;
  /// Motions of the faces that, with the body's responses, balance the forces on them.
  std::vector<double> face_motions() const;
  double conjugate_residual() const;
  /// |x - x0| / |x - old| over this body. Collective.
  double relative_move(const std::vector<double>& x, const std::vector<double>& x0,
                       const std::vector<double>& old) const;
  /// Evaluates x0 + lambda * increment; false, with the reason, if that cannot be done.
  bool try_increment(const NewtonProblem& problem, double lambda, const std::vector<double>& x0,
                     const std::vector<double>& p0, std::vector<double>& x, std::vector<double>& p,
                     NewtonReport& report);
  bool search(const NewtonProblem& problem, Balance before, std::vector<double>& x,
              std::vector<double>& p, NewtonReport& report);
};

}  // namespace polyslip::solver
