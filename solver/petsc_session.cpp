#include "solver/petsc_session.hpp"

#include <petscsys.h>

#include <cstdlib>

#include "core/error.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::solver {

PetscSession::PetscSession() {
  PetscBool initialised = PETSC_FALSE;
  check(PetscInitialized(&initialised));
  int finalised = 0;
  MPI_Finalized(&finalised);
  if (initialised || finalised) {
    throw core::InternalError("PetscSession: PETSc is running already, or MPI is over");
  }
  unsetenv("PETSC_OPTIONS");
  check(PetscOptionsSetValue(nullptr, "-skip_petscrc", "1"));
  check(PetscInitializeNoArguments());
  check(PetscOptionsClear(nullptr));
  check(PetscPopSignalHandler());
  check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
}

PetscSession::~PetscSession() {
  static_cast<void>(PetscPopErrorHandler());
  static_cast<void>(PetscFinalize());
}

}  // namespace polyslip::solver
