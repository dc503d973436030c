// Convergence of both elements on a manufactured solution of linear elasticity in the unit cube,
//   u = u0 + (mu/K) grad phi,  p = K div u = mu laplace phi,
//   u0 = (sin X cos Y cos Z, cos X sin Y cos Z, -2 cos X cos Y sin Z),  phi = cos X cos Y cos Z,
// X = pi x and so on: div u0 = 0, laplace u0 = -3 pi^2 u0, laplace phi = -3 pi^2 phi, no flux
// through the boundary and no shear on it. The pressure does not depend on K, so that errors can be
// compared between K. The mesh is unstructured: the mixed element has no uniform inf-sup constant
// on structured cubes, where its pressure is of half order only at K/mu = 1e5 (0.30, 0.19, 0.16 at
// 4, 8, 12 cells). Displacements of 1e-6 make the finite-strain element a linear one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"
#include "meshes.hpp"
#include "solver/newton.hpp"
#include "solver/partition.hpp"
#include "support/elastic_law.hpp"

namespace polyslip::solver {
namespace {

using core::Vec3;
constexpr double coarse_size = 0.25;  // c_l
constexpr double amplitude = 1e-6, mu = 1, pi = std::numbers::pi;

struct Solution {
  double bulk;

  static Vec3 swirl(const Vec3& x) {
    const Vec3 s = (pi * x).array().sin(), c = (pi * x).array().cos();
    return {s[0] * c[1] * c[2], c[0] * s[1] * c[2], -2 * c[0] * c[1] * s[2]};
  }
  static Vec3 gradient(const Vec3& x) {
    const Vec3 s = (pi * x).array().sin(), c = (pi * x).array().cos();
    return -pi * Vec3(s[0] * c[1] * c[2], c[0] * s[1] * c[2], c[0] * c[1] * s[2]);
  }
  Vec3 displacement(const Vec3& x) const {
    return amplitude * (swirl(x) + mu / bulk * gradient(x));
  }
  double pressure(const Vec3& x) const {
    const Vec3 c = (pi * x).array().cos();
    return -amplitude * 3 * pi * pi * mu * c[0] * c[1] * c[2];
  }
  /// -div sigma = -mu laplace u - (K + mu/3) grad div u
  Vec3 body_force(const Vec3& x) const {
    const double k2 = 3 * pi * pi;
    return amplitude * k2 * (mu * swirl(x) + mu / bulk * (mu + bulk + mu / 3) * gradient(x));
  }
};

struct Errors {
  double h = 0;                           // number of elements to the power -1/3
  double displacement = 0, pressure = 0;  // L2, relative
};

/// The mesh, its numbering, and 15 points in each element.
struct Problem {
  mesh::Mesh mesh;
  Distribution distribution;
  NodeExchange exchange;

  explicit Problem(double element_size)
      : mesh(tests::unstructured_cube(element_size)),
        distribution(MPI_COMM_SELF, mesh, partition_elements(mesh, 1)),
        exchange(distribution.local()) {}

  /// visit(element, shape functions, position, weight)
  template <class Visit>
  void for_each_point(const Visit& visit) const {
    for (int e = 0; e < mesh.element_count(); ++e)
      for (const auto& point : mesh::tet_quadrature_15()) {
        std::array<Vec3, 10> nodes;
        for (int a = 0; a < 10; ++a) nodes[a] = mesh.nodes[mesh.tetrahedra[e][a]];
        const auto shape = mesh::tet10_shape(point.xi);
        Vec3 x = Vec3::Zero();
        for (int a = 0; a < 10; ++a) x += shape[a] * nodes[a];
        const double det =
            mesh::tet10_jacobian(nodes, mesh::tet10_gradients(point.xi)).determinant();
        visit(e, shape, x, point.weight * det);
      }
  }
};

/// kappa: modulus of the points' volumes (solver/point_volumes.hpp).
Errors solve(double element_size, double bulk, bool mixed, double kappa = 0, int points = 4) {
  const PointRule& rule = point_rule(points);
  const Problem problem(element_size);
  const LocalMesh& local = problem.distribution.local();
  const Solution exact{bulk};
  const tests::ElasticLaw law(mu, bulk);
  Boundary boundary;
  for (int face = 0; face < 6; ++face)  // u n = 0 and no shear on the faces
    boundary.faces.push_back(
        {face, face / 2, [face](double) { return face % 2 == 1 ? 1.0 : 0.0; }});

  Configuration old;
  for (const auto& node : problem.mesh.nodes) old.x.insert(old.x.end(), node.begin(), node.end());
  old.p.assign(local.elements.size(), 0);
  old.volume_ratio.assign(local.elements.size() * static_cast<std::size_t>(rule.slots), 1);
  old.state.assign(local.elements.size() * 6 * static_cast<std::size_t>(rule.slots), 0);
  NewtonProblem step{old, 1.0, amplitude, kappa, 0, std::vector<double>(old.x.size(), 0)};
  problem.for_each_point([&](int e, const auto& shape, const Vec3& x, double weight) {
    const Vec3 b = exact.body_force(x);
    for (int a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i)
        step.external_forces[3 * static_cast<std::size_t>(local.elements[e][a]) + i] +=
            weight * shape[a] * b[i];
  });

  Discretisation discretisation(local, problem.exchange, law, mixed, rule, old.x, {});
  SolverOptions options;
  options.newton_tolerance = 1e-6;
  options.linear_tolerance = 1e-6;
  NewtonSolver newton(discretisation, boundary, options, old.x);
  std::vector<double> x = old.x, p = old.p;
  for (std::size_t node = 0; node < problem.mesh.nodes.size(); ++node)
    for (int i = 0; i < 3; ++i)
      if (newton.constrained()[3 * node + i])
        x[3 * node + i] = boundary.position(local.node_faces[node], i, problem.mesh.nodes[node], 1);
  const NewtonReport report = newton.solve(step, x, p);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_GT(report.iterations, 0);

  double u_error = 0, u_norm = 0, p_error = 0, p_norm = 0;
  problem.for_each_point([&](int e, const auto& shape, const Vec3& at, double weight) {
    Vec3 u = Vec3::Zero();
    for (int a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i) {
        const auto dof = 3 * static_cast<std::size_t>(local.elements[e][a]) + i;
        u[i] += shape[a] * (x[dof] - old.x[dof]);
      }
    u_error += weight * (u - exact.displacement(at)).squaredNorm();
    u_norm += weight * exact.displacement(at).squaredNorm();
    p_error += weight * std::pow(p[e] - exact.pressure(at), 2);
    p_norm += weight * std::pow(exact.pressure(at), 2);
  });
  return {1 / std::cbrt(problem.mesh.element_count()), std::sqrt(u_error / u_norm),
          std::sqrt(p_error / p_norm)};
}

double order(const Errors& coarse, const Errors& fine, double Errors::*error) {
  return std::log(coarse.*error / fine.*error) / std::log(coarse.h / fine.h);
}

TEST(ManufacturedSolution, MixedElementKeepsItsOrdersAndConstantsWhenNearlyIncompressible) {
  const Errors soft_coarse = solve(coarse_size, 10, true),
               soft_fine = solve(coarse_size / 2, 10, true);
  const Errors stiff_coarse = solve(coarse_size, 1e5, true),
               stiff_fine = solve(coarse_size / 2, 1e5, true);
  for (const auto& [coarse, fine] :
       {std::pair{soft_coarse, soft_fine}, std::pair{stiff_coarse, stiff_fine}}) {
    EXPECT_GT(order(coarse, fine, &Errors::displacement), 1.85);
    EXPECT_GT(order(coarse, fine, &Errors::pressure), 0.9);
    EXPECT_LT(fine.displacement, 0.05);
    EXPECT_GT(fine.displacement, 1e-5);
  }
  EXPECT_NEAR(stiff_fine.displacement / soft_fine.displacement, 1, 0.1);
  EXPECT_NEAR(stiff_fine.pressure / soft_fine.pressure, 1, 0.1);
}

TEST(ManufacturedSolution, PointsVolumesCostTheMixedElementNoOrder) {
  const double kappa = point_volume_share * mu;  // as in a step: the share of the shear modulus
  const Errors coarse = solve(coarse_size, 1e5, true, kappa),
               fine = solve(coarse_size / 2, 1e5, true, kappa),
               plain = solve(coarse_size / 2, 1e5, true);
  EXPECT_GT(order(coarse, fine, &Errors::displacement), 1.85);
  EXPECT_GT(order(coarse, fine, &Errors::pressure), 0.9);
  EXPECT_LT(fine.displacement, 1.2 * plain.displacement);
  EXPECT_LT(fine.pressure, 1.2 * plain.pressure);
}

TEST(ManufacturedSolution, DisplacementElementIsOfThirdOrderWhenCompressible) {
  const Errors coarse = solve(coarse_size, 10, false), fine = solve(coarse_size / 2, 10, false);
  EXPECT_GT(order(coarse, fine, &Errors::displacement), 2.8);
  EXPECT_LT(fine.displacement, 0.01);
  EXPECT_GT(fine.displacement, 1e-6);
}

TEST(ManufacturedSolution, BothElementsKeepTheirOrdersWithFifteenPoints) {
  const Errors mixed_coarse = solve(coarse_size, 1e5, true, 0, 15),
               mixed_fine = solve(coarse_size / 2, 1e5, true, 0, 15);
  EXPECT_GT(order(mixed_coarse, mixed_fine, &Errors::displacement), 1.85);
  EXPECT_GT(order(mixed_coarse, mixed_fine, &Errors::pressure), 0.9);
  const Errors coarse = solve(coarse_size, 10, false, 0, 15),
               fine = solve(coarse_size / 2, 10, false, 0, 15);
  EXPECT_GT(order(coarse, fine, &Errors::displacement), 2.8);
  EXPECT_LT(fine.displacement, 0.01);
  EXPECT_GT(fine.displacement, 1e-6);
}

}  // namespace
}  // namespace polyslip::solver
