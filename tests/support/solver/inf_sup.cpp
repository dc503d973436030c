#include "support/solver/inf_sup.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
#include "solver/element.hpp"

namespace polyslip::test {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

bool held(const mesh::Mesh& mesh, int node, int direction) {
  const double x = mesh.nodes[node][direction], length = mesh.size[direction];
  const bool low = std::abs(x) < 1e-6 * length, high = std::abs(x - length) < 1e-6 * length;
  return low || (high && direction > 0);
}

/// The operator M^-1/2 B A^-1 B^T M^-1/2; A falls into one matrix a direction.
class Schur {
 public:
  explicit Schur(const mesh::Mesh& mesh) : scale_(mesh.element_count()) {
    std::array<std::vector<Eigen::Triplet<double>>, 3> a, b;
    std::array<std::vector<int>, 3> unknown;
    std::array<int, 3> count{};
    for (int i = 0; i < 3; ++i)
      for (int n = 0; n < mesh.node_count(); ++n)
        unknown[i].push_back(held(mesh, n, i) ? -1 : count[i]++);
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto& nodes = mesh.tetrahedra[e];
      solver::ElementPositions x;
      for (int k = 0; k < 10; ++k)
        for (int i = 0; i < 3; ++i) x[k][i] = mesh.nodes[nodes[k]][i];
      solver::ElementGeometry g;
      if (!solver::element_geometry(solver::point_rule(4), x, g))
        throw core::InternalError("inf_sup_constant: an inverted element");
      scale_[e] = 1 / std::sqrt(g.volume);
      solver::ElementForces volume;
      solver::element_volume_gradient(g, volume);
      for (int k = 0; k < 10; ++k)
        for (int i = 0; i < 3; ++i) {
          const int row = unknown[i][nodes[k]];
          if (row < 0) continue;
          b[i].emplace_back(row, e, volume[k][i] * scale_[e]);
          for (int l = 0; l < 10; ++l) {
            const int column = unknown[i][nodes[l]];
            if (column < 0) continue;
            double product = 0;
            for (int q = 0; q < g.points; ++q)
              for (int j = 0; j < 3; ++j)
                product += g.weights[q] * g.gradients[q][j][k] * g.gradients[q][j][l];
            a[i].emplace_back(row, column, product);
          }
        }
    }
    for (int i = 0; i < 3; ++i) {
      Matrix A(count[i], count[i]);
      A.setFromTriplets(a[i].begin(), a[i].end());
      factor_[i].compute(A);
      if (factor_[i].info() != Eigen::Success)
        throw core::InternalError("inf_sup_constant: a direction is not held");
      transposed_[i].resize(count[i], mesh.element_count());
      transposed_[i].setFromTriplets(b[i].begin(), b[i].end());
    }
  }

  Vector operator()(const Vector& p) const {
    Vector out = Vector::Zero(p.size());
    for (int i = 0; i < 3; ++i)
      out += transposed_[i].transpose() * factor_[i].solve(transposed_[i] * p);
    return out;
  }
  Eigen::Index size() const { return scale_.size(); }

 private:
  Vector scale_;
  std::array<Eigen::SimplicialLLT<Matrix>, 3> factor_;
  std::array<Matrix, 3> transposed_;  // B^T M^-1/2
};

/// Smallest eigenvalue by Lanczos' method with full orthogonalisation, to a part in 10^6.
double smallest_eigenvalue(const Schur& S) {
  const Eigen::Index most = std::min<Eigen::Index>(S.size(), 400);
  core::Random random(1, core::Stream::tests);
  std::vector<Vector> basis(1, Vector(S.size()));
  for (double& c : basis[0]) c = random.uniform(-1, 1);
  basis[0].normalize();
  std::vector<double> diagonal, side;
  double last = 0;
  for (Eigen::Index k = 0; k < most; ++k) {
    Vector w = S(basis.back());
    diagonal.push_back(w.dot(basis.back()));
    for (int twice = 0; twice < 2; ++twice)
      for (const Vector& v : basis) w -= w.dot(v) * v;
    side.push_back(w.norm());
    if (k % 10 == 9 || side.back() < 1e-12 || k + 1 == most) {
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
      const auto n = static_cast<Eigen::Index>(diagonal.size());
      solver.computeFromTridiagonal(Eigen::Map<Vector>(diagonal.data(), n),
                                    Eigen::Map<Vector>(side.data(), n - 1), Eigen::EigenvaluesOnly);
      const double smallest = solver.eigenvalues()[0];
      if (std::abs(smallest - last) < 1e-6 * smallest || side.back() < 1e-12) return smallest;
      last = smallest;
    }
    basis.push_back(w / side.back());
  }
  if (most < S.size()) throw core::InternalError("inf_sup_constant: no convergence");
  return last;
}

}  // namespace

double inf_sup_constant(const mesh::Mesh& mesh) {
  return std::sqrt(smallest_eigenvalue(Schur(mesh)));
}

}  // namespace polyslip::test
