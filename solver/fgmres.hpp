#pragma once
// Flexible GMRES (Saad, SIAM J. Sci. Comput. 14, 1993), right preconditioned, without restart.

#include <mpi.h>

#include <functional>
#include <vector>

#include "solver/profile.hpp"

namespace polyslip::solver {

/// Sums are taken over fixed blocks of entries and then over the ranks in their order: the bits do
/// not depend on the number of threads. Keeps its vectors from one solve to the next.
class FlexibleGmres {
 public:
  FlexibleGmres(MPI_Comm comm, std::size_t local_size, Profile* profile = nullptr)
      : comm_(comm), size_(local_size), profile_(profile) {}

  /// y = A x
  using Operator = std::function<void(const double* x, double* y)>;
  /// z ~ A^-1 v, single precision: it is A z that counts, and that is exact.
  using Preconditioner = std::function<void(const double* v, float* z)>;
  struct Report {
    int iterations = 0;
    double start = 0;     ///< |b - A x| at the guess
    double residual = 0;  ///< the same in the end, as the recurrence has it
    bool converged = false;
  };
  /// x, a guess on entry, to |b - A x| <= tolerance |b|. Collective.
  Report improve(const Operator& A, const Preconditioner& M, const double* b, double* x,
                 double tolerance, int max_iterations);
  /// The same from a zero guess.
  Report solve(const Operator& A, const Preconditioner& M, const double* b, double* x,
               double tolerance, int max_iterations);

  double norm(const double* v) const;
  /// Gives back the memory of the vectors.
  void release();

 private:
  MPI_Comm comm_;
  std::size_t size_;
  Profile* profile_;
  std::vector<std::vector<double>> basis_;
  std::vector<std::vector<float>> directions_;

  /// Adds to x what brings its residual, in basis 0 on entry, below `wanted`.
  void iterate(const Operator& A, const Preconditioner& M, double* x, double wanted,
               int max_iterations, Report& report);
  /// The first vector of the basis.
  double* first();
  /// out[k] = basis k . w, k < count
  std::vector<double> dots(int count, const double* w) const;
  /// w -= sum of coefficients times basis vectors
  void subtract(const std::vector<double>& coefficients, double* w) const;
};

}  // namespace polyslip::solver
