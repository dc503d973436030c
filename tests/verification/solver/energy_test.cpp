// The balance of energy: what the faces do on the body is stored in its elastic strains, dissipated
// by slip or, in the mixed element, by the resistance of the points' volumes
// (solver/point_volumes.hpp). All are computed here from the states alone, by the law's equations
// (docs/theory-material.md), not from what the solver has integrated.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/tensor.hpp"
#include "material/slip_systems.hpp"
#include "solver/element.hpp"
#include "solver/model.hpp"
#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

using core::Vec5;

/// Of one state: stored energy [MPa L^3], rate of dissipation by slip [MPa L^3/s].
struct Energy {
  double stored = 0, dissipation = 0;
  // [elements][points] volume that a point stands for; its mean stress less its element's [MPa]
  std::vector<double> volumes, departures;
};

/// Deviatoric stress in crystal axes: C11 - C12 on the two modes of the normal strains, 2 C44 on
/// those of shear.
Vec5 crystal_stress(const Vec5& strain, const material::MaterialOptions& o) {
  Vec5 stress = 2 * o.c44 * strain;
  stress.head<2>() = (o.c11 - o.c12) * strain.head<2>();
  return stress;
}

/// sum over the systems of tau gammadot [MPa/s]
double slip_power(const Vec5& stress, double g, const material::MaterialOptions& o) {
  static const auto systems = material::fcc_slip_systems();
  double power = 0;
  for (const auto& system : systems) {
    const double tau = system.direction.dot(core::from_deviator5(stress) * system.normal);
    power +=
        std::abs(tau) * o.reference_slip_rate * std::pow(std::abs(tau) / g, 1 / o.rate_sensitivity);
  }
  return power;
}

Energy energy_of(const mesh::Snapshot& s, const material::MaterialOptions& o, bool mixed) {
  using mesh::Location;
  const PointRule& rule = point_rule(s.quadrature_points);
  const auto values = [&](const char* name, Location at) -> const std::vector<double>& {
    return s.find(name, at)->values;
  };
  const auto &strain = values("elastic_strain", Location::quadrature_point),
             &g = values("g", Location::quadrature_point),
             &cauchy = values("cauchy_stress", Location::quadrature_point),
             &pressure = values("pressure", Location::element);
  const double bulk = (o.c11 + 2 * o.c12) / 3;
  Energy energy;
  for (std::size_t e = 0; e < s.mesh.tetrahedra.size(); ++e) {
    ElementPositions x;
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i) x[a][i] = s.mesh.nodes[s.mesh.tetrahedra[e][a]][i];
    ElementGeometry geometry;
    EXPECT_TRUE(element_geometry(rule, x, geometry));
    for (int q = 0; q < rule.points; ++q) {
      const std::size_t at = e * static_cast<std::size_t>(rule.points) + q;
      const double w = geometry.weights[q];
      const Vec5 elastic = Eigen::Map<const Vec5>(&strain[5 * at]);
      const Vec5 stress = crystal_stress(elastic, o);
      const double mean = (cauchy[6 * at] + cauchy[6 * at + 1] + cauchy[6 * at + 2]) / 3;
      const double elastic_mean = mixed ? -pressure[e] : mean;
      energy.stored += w * (0.5 * stress.dot(elastic) + elastic_mean * elastic_mean / (2 * bulk));
      energy.dissipation += w * slip_power(stress, g[at], o);
      energy.volumes.push_back(w);
      energy.departures.push_back(mean - elastic_mean);
    }
  }
  return energy;
}

/// Work of the points' volume resistance over a step: of a viscosity, its stress at the end.
double resistance_work(const Energy& before, const Energy& after) {
  double work = 0;
  for (std::size_t q = 0; q < before.volumes.size(); ++q)
    work += after.volumes[q] * after.departures[q] * std::log(after.volumes[q] / before.volumes[q]);
  return work;
}

struct Balance {
  double imbalance = 0;   ///< (external work - stored - dissipated) / external work
  double resistance = 0;  ///< share of the points' volumes in the work
};

/// At strain 0.3 of a few grains.
Balance balance_of(const char* element, double largest_step) {
  const material::MaterialOptions o;
  const auto law = material::make_fcc_law(o);
  LoadingOptions loading;
  loading.max_strain_increment = largest_step;
  SolverOptions options;
  options.element = element;
  const bool mixed = options.element == "mixed", root = tests::on_root(MPI_COMM_WORLD);
  const double height = 1.2;  // of the slab box
  Model model(MPI_COMM_WORLD, tests::slab_box(MPI_COMM_WORLD, *law), *law, loading, options, {});
  double work = 0, dissipated = 0, resisted = 0, force = 0, z = height, time = 0;
  Energy now;
  while (model.strain() < 0.3) {
    const StepRecord r = model.step(0.3);
    const double z_new = height * std::exp(-r.strain);
    work += (force + r.fz_z1) / 2 * (z_new - z);
    const mesh::Snapshot s = model.snapshot();
    if (root) {
      Energy next = energy_of(s, o, mixed);
      dissipated += (now.dissipation + next.dissipation) / 2 * (r.time - time);
      resisted += resistance_work(now, next);
      now = std::move(next);
    }
    force = r.fz_z1, z = z_new, time = r.time;
  }
  if (!root) return {};
  const Balance b{(work - now.stored - dissipated - resisted) / work, resisted / work};
  fmt::print(
      "{}, steps of {}: work {:.4f}, stored {:.5f}, dissipated by slip {:.4f} MPa L^3, by "
      "points' volumes {:.3f} %; out of balance {:+.4f} %\n",
      element, largest_step, work, now.stored, dissipated, 100 * b.resistance, 100 * b.imbalance);
  EXPECT_GT(work, 1);
  EXPECT_GT(dissipated, 1);
  return b;
}

class Energies : public ::testing::TestWithParam<const char*> {};

TEST_P(Energies, AreBalancedWithinHalfAPercentTheMoreTheSmallerTheSteps) {
  const Balance coarse = balance_of(GetParam(), 0.02), fine = balance_of(GetParam(), 0.01),
                finer = balance_of(GetParam(), 0.005);
  if (!tests::on_root(MPI_COMM_WORLD)) return;
  EXPECT_LT(std::abs(fine.imbalance), 0.005);
  EXPECT_LT(std::abs(fine.imbalance), 0.7 * std::abs(coarse.imbalance));
  EXPECT_LT(std::abs(finer.imbalance), 0.7 * std::abs(fine.imbalance));
  EXPECT_LT(fine.resistance, 0.015);
}

INSTANTIATE_TEST_SUITE_P(Elements, Energies, ::testing::Values("mixed", "displacement"));

}  // namespace
}  // namespace polyslip::solver
