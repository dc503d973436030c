#pragma once
// `polyslip run`: from a deck, or a run folder, to a deformed polycrystal.

#include <mpi.h>

#include <string>

#include "mesh/volume_mesher.hpp"

namespace polyslip::drivers {

/// Exit codes of the program.
inline constexpr int exit_fine = 0, exit_internal_error = 1, exit_input_error = 2, exit_stopped = 3;

struct RunRequest {
  std::string deck;    ///< path; empty for a restart
  std::string folder;  ///< run folder
  bool overwrite = false;
  bool restart = false;
  bool profile = false;
  int jobs = 0;  ///< mesher processes and threads of meshing; 0: one a core
};

/// The whole job. Collective. Returns `exit_fine`, or `exit_stopped` when a step or a remeshing
/// failed for good and a restartable state was left. Throws InputError on every rank, before any
/// file is touched if the deck or the folder is wrong.
int run(MPI_Comm comm, const RunRequest& request, mesh::MesherPool& pool);

}  // namespace polyslip::drivers
