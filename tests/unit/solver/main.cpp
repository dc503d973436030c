// Runs the tests on every rank of MPI_COMM_WORLD; a failure on any rank fails the program.
#include <gtest/gtest.h>
#include <mpi.h>

#include "solver/petsc_session.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const polyslip::solver::PetscSession session;
  int failed = RUN_ALL_TESTS();
  if (MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD) != 0) failed = 1;
  return failed;
}
