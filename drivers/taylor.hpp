#pragma once
// `polyslip taylor`: the Taylor model of a deck, with the same files as a run where they apply.

#include <mpi.h>

#include <string>

#include "core/types.hpp"
#include "drivers/options.hpp"

namespace polyslip::drivers {

struct TaylorRequest {
  std::string deck;    ///< path
  std::string folder;  ///< run folder
  bool overwrite = false;
};

/// Every orientation under the load's mean deformation gradient (solver::Boundary), by the deck's
/// steps. The pressure, of which full constraints say nothing, is that which frees the load's free
/// axes of mean normal stress, zero for loads without them. Leaves deck, log.txt, macro.csv (forces
/// are NaN), summary.json and results/. Collective. Returns an exit code of drivers/run.hpp; throws
/// InputError on every rank, before any file is touched if deck or folder is wrong.
int taylor(MPI_Comm comm, const TaylorRequest& request);

/// The orientations that a Taylor model of the deck has: [taylor] orientations random ones of its
/// distribution, or those of the grains.
std::vector<core::Quaternion> taylor_orientations(const Options& options);

/// Axes whose mean normal stress is zero: those that `type` leaves free.
std::vector<int> free_axes(const solver::LoadingOptions& loading);

/// Taylor factors of initial orientations for the load's first velocity gradient, elasticity being
/// over and without hardening, at a von Mises rate of the reference slip rate; by the rate
/// sensitivity m they go to other rates as (rate / reference rate)^m.
struct TaylorFactors {
  double stress = 0;  ///< sigma : D / (von Mises rate of D), over g
  double slip = 0;    ///< sum of |slip rates| over the von Mises rate
};
/// Collective; the same on all ranks.
TaylorFactors initial_taylor_factors(MPI_Comm comm, const Options& options,
                                     const std::vector<core::Quaternion>& orientations);

}  // namespace polyslip::drivers
