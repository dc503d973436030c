#pragma once
// Data between ranks. MPI's own error handler (fatal, the default) checks every call. Everything
// here adds and unpacks in the order of the ranks, never in the order of arrival, so that the same
// number of ranks gives the same bits.

#include <mpi.h>

#include <functional>
#include <type_traits>
#include <vector>

namespace polyslip::solver {

int rank_of(MPI_Comm comm);
int size_of(MPI_Comm comm);

/// Sums, smallest, largest over the ranks; the same value on each. Collective.
double sum(MPI_Comm comm, double value);
void sum(MPI_Comm comm, double* values, int count);
double minimum(MPI_Comm comm, double value);
double maximum(MPI_Comm comm, double value);
int maximum(MPI_Comm comm, int value);

/// Runs `task` on rank 0; an exception there is thrown on every rank, with its kind and text.
/// Collective.
void on_root(MPI_Comm comm, const std::function<void()>& task);

/// A number of bytes as MPI takes it; throws core::InternalError beyond 2 GB.
int message_size(std::size_t bytes);

namespace detail {
void scatter_bytes(MPI_Comm comm, const std::vector<std::vector<char>>& parts,
                   std::vector<char>& mine);
std::vector<std::vector<char>> gather_bytes(MPI_Comm comm, const std::vector<char>& mine);
std::vector<std::vector<char>> exchange_bytes(MPI_Comm comm, const std::vector<int>& ranks,
                                              const std::vector<std::vector<char>>& parts);

template <class T>
std::vector<char> to_bytes(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const char* begin = reinterpret_cast<const char*>(values.data());
  return {begin, begin + values.size() * sizeof(T)};
}
template <class T>
std::vector<T> from_bytes(const std::vector<char>& bytes) {
  const T* begin = reinterpret_cast<const T*>(bytes.data());
  return {begin, begin + bytes.size() / sizeof(T)};
}
template <class T>
std::vector<std::vector<char>> to_bytes(const std::vector<std::vector<T>>& parts) {
  std::vector<std::vector<char>> bytes;
  for (const auto& part : parts) bytes.push_back(to_bytes(part));
  return bytes;
}
template <class T>
std::vector<std::vector<T>> from_bytes(const std::vector<std::vector<char>>& bytes) {
  std::vector<std::vector<T>> parts;
  for (const auto& part : bytes) parts.push_back(from_bytes<T>(part));
  return parts;
}
}  // namespace detail

/// parts[r], known to rank 0, arrives on rank r. Collective.
template <class T>
std::vector<T> scatter(MPI_Comm comm, const std::vector<std::vector<T>>& parts) {
  std::vector<char> mine;
  detail::scatter_bytes(comm, detail::to_bytes(parts), mine);
  return detail::from_bytes<T>(mine);
}

/// Every rank's `mine` on rank 0, empty elsewhere. Collective.
template <class T>
std::vector<std::vector<T>> gather(MPI_Comm comm, const std::vector<T>& mine) {
  return detail::from_bytes<T>(detail::gather_bytes(comm, detail::to_bytes(mine)));
}

/// Every rank's `mine` on every rank. Collective.
template <class T>
std::vector<T> all_gather(MPI_Comm comm, const T& mine) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> all(static_cast<std::size_t>(size_of(comm)));
  MPI_Allgather(&mine, sizeof(T), MPI_BYTE, all.data(), sizeof(T), MPI_BYTE, comm);
  return all;
}

/// Sends parts[i] to ranks[i] and returns what they sent, in the same order. Both sides must name
/// each other. Collective among the ranks named.
template <class T>
std::vector<std::vector<T>> exchange(MPI_Comm comm, const std::vector<int>& ranks,
                                     const std::vector<std::vector<T>>& parts) {
  return detail::from_bytes<T>(detail::exchange_bytes(comm, ranks, detail::to_bytes(parts)));
}

/// `value` of rank 0 on every rank. Collective.
template <class T>
T broadcast(MPI_Comm comm, T value) {
  static_assert(std::is_trivially_copyable_v<T>);
  MPI_Bcast(&value, sizeof(T), MPI_BYTE, 0, comm);
  return value;
}

}  // namespace polyslip::solver
