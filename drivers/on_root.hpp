#pragma once
// Work that one rank does while the others wait, with its failures reaching all of them.

#include <mpi.h>

#include <functional>

namespace polyslip::drivers {

/// Runs `work` on rank 0. The other ranks wait without using their processors (rank 0's mesher
/// processes need them). An InputError, RecoverableError or other exception of `work` is thrown on
/// every rank, with the same text. Collective.
void on_root(MPI_Comm comm, const std::function<void()>& work);

}  // namespace polyslip::drivers
