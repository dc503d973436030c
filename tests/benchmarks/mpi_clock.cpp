#include "benchmarks/mpi_clock.hpp"

#include <mpi.h>

#include <ctime>
#include <map>

namespace polyslip::benchmarks {
namespace {

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Bytes of persistent sends.
std::map<MPI_Request, std::int64_t>& persistent() {
  static std::map<MPI_Request, std::int64_t> sends;
  return sends;
}

/// Books a call until it ends.
class Call {
 public:
  Call() : wall_(PMPI_Wtime()), cpu_(cpu_seconds()) {}
  ~Call() {
    mpi_clock().wall += PMPI_Wtime() - wall_;
    mpi_clock().cpu += cpu_seconds() - cpu_;
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  double wall_, cpu_;
};

std::int64_t bytes_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<std::int64_t>(count) * size;
}

void count_send(std::int64_t bytes) {
  ++mpi_clock().messages;
  mpi_clock().bytes += bytes;
}

void count_start(MPI_Request request) {
  const auto send = persistent().find(request);
  if (send != persistent().end()) count_send(send->second);
}

template <class F>
int collective(const F& f) {
  ++mpi_clock().collectives;
  const Call call;
  return f();
}

}  // namespace

MpiClock& mpi_clock() {
  static MpiClock clock;
  return clock;
}

}  // namespace polyslip::benchmarks

using polyslip::benchmarks::bytes_of;
using polyslip::benchmarks::Call;
using polyslip::benchmarks::collective;
using polyslip::benchmarks::count_send;
using polyslip::benchmarks::count_start;
using polyslip::benchmarks::persistent;

extern "C" {

int MPI_Send(const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c) {
  count_send(bytes_of(n, t));
  const Call call;
  return PMPI_Send(b, n, t, to, tag, c);
}
int MPI_Isend(const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request* r) {
  count_send(bytes_of(n, t));
  const Call call;
  return PMPI_Isend(b, n, t, to, tag, c, r);
}
int MPI_Send_init(const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c,
                  MPI_Request* r) {
  const int code = PMPI_Send_init(b, n, t, to, tag, c, r);
  persistent()[*r] = bytes_of(n, t);
  return code;
}
int MPI_Request_free(MPI_Request* r) {
  persistent().erase(*r);
  return PMPI_Request_free(r);
}
int MPI_Start(MPI_Request* r) {
  count_start(*r);
  const Call call;
  return PMPI_Start(r);
}
int MPI_Startall(int n, MPI_Request* r) {
  for (int i = 0; i < n; ++i) count_start(r[i]);
  const Call call;
  return PMPI_Startall(n, r);
}
int MPI_Recv(void* b, int n, MPI_Datatype t, int from, int tag, MPI_Comm c, MPI_Status* s) {
  const Call call;
  return PMPI_Recv(b, n, t, from, tag, c, s);
}
int MPI_Wait(MPI_Request* r, MPI_Status* s) {
  const Call call;
  return PMPI_Wait(r, s);
}
int MPI_Waitall(int n, MPI_Request* r, MPI_Status* s) {
  const Call call;
  return PMPI_Waitall(n, r, s);
}
int MPI_Waitany(int n, MPI_Request* r, int* i, MPI_Status* s) {
  const Call call;
  return PMPI_Waitany(n, r, i, s);
}
int MPI_Waitsome(int n, MPI_Request* r, int* m, int* i, MPI_Status* s) {
  const Call call;
  return PMPI_Waitsome(n, r, m, i, s);
}
int MPI_Barrier(MPI_Comm c) {
  return collective([&] { return PMPI_Barrier(c); });
}
int MPI_Bcast(void* b, int n, MPI_Datatype t, int root, MPI_Comm c) {
  return collective([&] { return PMPI_Bcast(b, n, t, root, c); });
}
int MPI_Reduce(const void* b, void* o, int n, MPI_Datatype t, MPI_Op op, int root, MPI_Comm c) {
  return collective([&] { return PMPI_Reduce(b, o, n, t, op, root, c); });
}
int MPI_Allreduce(const void* b, void* o, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c) {
  return collective([&] { return PMPI_Allreduce(b, o, n, t, op, c); });
}
int MPI_Allgather(const void* b, int n, MPI_Datatype t, void* o, int m, MPI_Datatype u,
                  MPI_Comm c) {
  return collective([&] { return PMPI_Allgather(b, n, t, o, m, u, c); });
}
int MPI_Allgatherv(const void* b, int n, MPI_Datatype t, void* o, const int* m, const int* at,
                   MPI_Datatype u, MPI_Comm c) {
  return collective([&] { return PMPI_Allgatherv(b, n, t, o, m, at, u, c); });
}
int MPI_Gather(const void* b, int n, MPI_Datatype t, void* o, int m, MPI_Datatype u, int root,
               MPI_Comm c) {
  return collective([&] { return PMPI_Gather(b, n, t, o, m, u, root, c); });
}
int MPI_Scatter(const void* b, int n, MPI_Datatype t, void* o, int m, MPI_Datatype u, int root,
                MPI_Comm c) {
  return collective([&] { return PMPI_Scatter(b, n, t, o, m, u, root, c); });
}

}  // extern "C"
