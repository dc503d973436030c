#pragma once
// What a program does in MPI, its libraries included: time inside calls that wait, messages and
// their bytes, operations of all ranks. By wrappers of the calls in the profiling interface of MPI
// (MPI standard 3.1, chapter 14); linking mpi_clock.cpp turns them on.

#include <cstdint>

namespace polyslip::benchmarks {

/// Of this rank.
struct MpiClock {
  double wall = 0, cpu = 0;              ///< s inside MPI
  std::int64_t messages = 0, bytes = 0;  ///< point to point, sent
  std::int64_t collectives = 0;          ///< operations of all ranks
};

/// Since the start or the last reset.
MpiClock& mpi_clock();

}  // namespace polyslip::benchmarks
