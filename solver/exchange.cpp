#include "solver/exchange.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

double reduce(MPI_Comm comm, double value, MPI_Op op) {
  double result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, op, comm);
  return result;
}

}  // namespace

int message_size(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw core::InternalError("exchange: more than 2 GB in one message");
  return static_cast<int>(bytes);
}

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int size_of(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size;
}

double sum(MPI_Comm comm, double value) {
  sum(comm, &value, 1);
  return value;
}

void sum(MPI_Comm comm, double* values, int count) {
  const int ranks = size_of(comm);
  if (ranks == 1) return;
  std::vector<double> all(static_cast<std::size_t>(count) * ranks);
  MPI_Allgather(values, count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, comm);
  for (int i = 0; i < count; ++i) {
    values[i] = 0;
    for (int r = 0; r < ranks; ++r) values[i] += all[static_cast<std::size_t>(r) * count + i];
  }
}

double minimum(MPI_Comm comm, double value) { return reduce(comm, value, MPI_MIN); }
double maximum(MPI_Comm comm, double value) { return reduce(comm, value, MPI_MAX); }

int maximum(MPI_Comm comm, int value) {
  int result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_INT, MPI_MAX, comm);
  return result;
}

void on_root(MPI_Comm comm, const std::function<void()>& task) {
  enum Outcome { fine, input, recoverable, internal };
  int outcome = fine;
  std::string message;
  if (rank_of(comm) == 0) {
    try {
      task();
    } catch (const core::InputError& e) {
      outcome = input;
      message = e.what();
    } catch (const core::RecoverableError& e) {
      outcome = recoverable;
      message = e.what();
    } catch (const std::exception& e) {
      outcome = internal;
      message = e.what();
    }
  }
  outcome = broadcast(comm, outcome);
  if (outcome == fine) return;
  int length = broadcast(comm, static_cast<int>(message.size()));
  message.resize(static_cast<std::size_t>(length));
  MPI_Bcast(message.data(), length, MPI_CHAR, 0, comm);
  if (outcome == input) throw core::InputError(message);
  if (outcome == recoverable) throw core::RecoverableError(message);
  throw core::InternalError(message);
}

namespace detail {

void scatter_bytes(MPI_Comm comm, const std::vector<std::vector<char>>& parts,
                   std::vector<char>& mine) {
  const int ranks = size_of(comm);
  std::vector<std::int64_t> counts(static_cast<std::size_t>(ranks), 0);
  const bool root = rank_of(comm) == 0;
  if (root)
    for (int r = 0; r < ranks; ++r) counts[r] = static_cast<std::int64_t>(parts[r].size());
  std::int64_t count = 0;
  MPI_Scatter(counts.data(), 1, MPI_INT64_T, &count, 1, MPI_INT64_T, 0, comm);
  if (root) {
    mine = parts[0];
    for (int r = 1; r < ranks; ++r)
      MPI_Send(parts[r].data(), message_size(parts[r].size()), MPI_BYTE, r, 0, comm);
  } else {
    mine.resize(static_cast<std::size_t>(count));
    MPI_Recv(mine.data(), message_size(mine.size()), MPI_BYTE, 0, 0, comm, MPI_STATUS_IGNORE);
  }
}

std::vector<std::vector<char>> gather_bytes(MPI_Comm comm, const std::vector<char>& mine) {
  const int ranks = size_of(comm);
  std::vector<std::int64_t> counts(static_cast<std::size_t>(ranks), 0);
  const auto count = static_cast<std::int64_t>(mine.size());
  MPI_Gather(&count, 1, MPI_INT64_T, counts.data(), 1, MPI_INT64_T, 0, comm);
  if (rank_of(comm) != 0) {
    MPI_Send(mine.data(), message_size(mine.size()), MPI_BYTE, 0, 0, comm);
    return {};
  }
  std::vector<std::vector<char>> parts(static_cast<std::size_t>(ranks));
  parts[0] = mine;
  for (int r = 1; r < ranks; ++r) {
    parts[r].resize(static_cast<std::size_t>(counts[r]));
    MPI_Recv(parts[r].data(), message_size(parts[r].size()), MPI_BYTE, r, 0, comm,
             MPI_STATUS_IGNORE);
  }
  return parts;
}

std::vector<std::vector<char>> exchange_bytes(MPI_Comm comm, const std::vector<int>& ranks,
                                              const std::vector<std::vector<char>>& parts) {
  const std::size_t n = ranks.size();
  std::vector<MPI_Request> requests(2 * n);
  std::vector<std::int64_t> out(n), in(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = static_cast<std::int64_t>(parts[i].size());
    MPI_Irecv(&in[i], 1, MPI_INT64_T, ranks[i], 1, comm, &requests[i]);
    MPI_Isend(&out[i], 1, MPI_INT64_T, ranks[i], 1, comm, &requests[n + i]);
  }
  MPI_Waitall(static_cast<int>(2 * n), requests.data(), MPI_STATUSES_IGNORE);
  std::vector<std::vector<char>> received(n);
  for (std::size_t i = 0; i < n; ++i) {
    received[i].resize(static_cast<std::size_t>(in[i]));
    MPI_Irecv(received[i].data(), message_size(received[i].size()), MPI_BYTE, ranks[i], 2, comm,
              &requests[i]);
    MPI_Isend(parts[i].data(), message_size(parts[i].size()), MPI_BYTE, ranks[i], 2, comm,
              &requests[n + i]);
  }
  MPI_Waitall(static_cast<int>(2 * n), requests.data(), MPI_STATUSES_IGNORE);
  return received;
}

}  // namespace detail
}  // namespace polyslip::solver
