#include "drivers/on_root.hpp"

#include <chrono>
#include <string>
#include <thread>

#include "core/error.hpp"

namespace polyslip::drivers {
namespace {

enum class Outcome : int { fine, input_error, recoverable_error, internal_error };

struct Result {
  Outcome outcome = Outcome::fine;
  std::string text;
};

Result outcome_of(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const core::InputError& e) {
    return {Outcome::input_error, e.what()};
  } catch (const core::RecoverableError& e) {
    return {Outcome::recoverable_error, e.what()};
  } catch (const std::exception& e) {
    return {Outcome::internal_error, e.what()};
  }
}

/// A barrier that sleeps. (MPI's own waits keep a processor busy.)
void quiet_barrier(MPI_Comm comm) {
  MPI_Request request;
  MPI_Ibarrier(comm, &request);
  for (int done = 0; !done;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void rethrow(const Result& result) {
  switch (result.outcome) {
    case Outcome::fine:
      return;
    case Outcome::input_error:
      throw core::InputError(result.text);
    case Outcome::recoverable_error:
      throw core::RecoverableError(result.text);
    case Outcome::internal_error:
      throw core::InternalError(result.text);
  }
}

}  // namespace

void on_root(MPI_Comm comm, const std::function<void()>& work) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  Result result;
  if (rank == 0) result = outcome_of(work);
  quiet_barrier(comm);
  int header[2] = {static_cast<int>(result.outcome), static_cast<int>(result.text.size())};
  MPI_Bcast(header, 2, MPI_INT, 0, comm);
  result.outcome = static_cast<Outcome>(header[0]);
  result.text.resize(static_cast<std::size_t>(header[1]));
  MPI_Bcast(result.text.data(), header[1], MPI_CHAR, 0, comm);
  rethrow(result);
}

}  // namespace polyslip::drivers
