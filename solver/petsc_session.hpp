#pragma once
// PETSc (and MPI) from start to finish of a program.

namespace polyslip::solver {

/// Initialises PETSc on construction and finalises it on destruction; MPI too, unless the caller
/// has initialised it. Errors are returned, neither printed nor fatal (see `check`); no user file,
/// environment variable or command line reaches PETSc's options; signals are left alone.
/// Collective over MPI_COMM_WORLD. One at a time: throws core::InternalError if PETSc runs already
/// or MPI is over.
class PetscSession {
 public:
  PetscSession();
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

}  // namespace polyslip::solver
