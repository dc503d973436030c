#include "solver/petsc_handle.hpp"

#include <fmt/format.h>

#include <string>

#include "core/error.hpp"

namespace polyslip::solver::detail {

void throw_petsc_error(PetscErrorCode code, const std::source_location& where) {
  const char* kind = nullptr;
  char* specific = nullptr;
  static_cast<void>(PetscErrorMessage(static_cast<int>(code), &kind, &specific));
  std::string message =
      fmt::format("{}:{}: PETSc error {}", where.file_name(), where.line(), static_cast<int>(code));
  if (kind) message += fmt::format(" ({})", kind);
  if (specific && *specific) message += fmt::format(": {}", specific);
  throw core::InternalError(message);
}

}  // namespace polyslip::solver::detail
