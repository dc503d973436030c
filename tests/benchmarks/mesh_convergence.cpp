// How stress, orientation and pressure of a polycrystal of 20 grains in plane-strain compression
// change with its mesh (docs/verification.md): each mesh against the last, finest one.
// mesh_convergence WORKER ELEMENT STRAIN STEP ELEMENT_SIZE...   ELEMENT: mixed or displacement
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/rotation.hpp"
#include "remap/locator.hpp"
#include "solver/model.hpp"
#include "solver/petsc_session.hpp"
#include "support/crystal_boxes.hpp"
#include "support/polycrystal_mesh.hpp"

namespace {

using namespace polyslip;
using core::Vec3;
using core::Vec6;

constexpr int grains = 20, samples_along = 16;

struct Solution {
  mesh::Mesh start;
  mesh::Snapshot end;
  double stress = 0;  // von Mises of the mean, MPa
};

double von_mises(Vec6 s) {
  const double p = s.head<3>().sum() / 3;
  s.head<3>().array() -= p;
  return std::sqrt(1.5 * (s.head<3>().squaredNorm() + 2 * s.tail<3>().squaredNorm()));
}

Solution solve(mesh::MesherPool& pool, const std::string& element, double strain, double step,
               double size) {
  const auto law = material::make_fcc_law({});
  Solution out;
  out.start = tests::polycrystal_mesh(pool, grains, size);
  const auto start = solver::initial_snapshot(out.start, tests::some_orientations(grains), *law);
  solver::LoadingOptions loading;
  loading.max_strain_increment = step;
  loading.initial_strain_increment = step / 8;
  solver::SolverOptions options;
  options.element = element;
  solver::Model model(MPI_COMM_SELF, start, *law, loading, options, {});
  while (model.strain() < strain)
    out.stress = von_mises(Eigen::Map<const Vec6>(model.step(strain).stress.data()));
  out.end = model.snapshot();
  return out;
}

/// What the linear functions through the four points of an element say at a place in it.
struct Values {
  core::Quaternion orientation;
  Vec6 stress = Vec6::Zero();
  double pressure = 0;
};

Values values_at(const Solution& s, const remap::Location& at) {
  const auto& q = s.end.find("orientation", mesh::Location::quadrature_point)->values;
  const auto& stress = s.end.find("cauchy_stress", mesh::Location::quadrature_point)->values;
  // Barycentric coordinates at the points of the rule: (5 - sqrt 5)/20, 1/sqrt 5 more at their own.
  const double l[4] = {1 - at.xi.sum(), at.xi[0], at.xi[1], at.xi[2]};
  const auto first = 4 * static_cast<std::size_t>(at.element);
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Values v;
  for (std::size_t p = 0; p < 4; ++p) {
    const double share = (l[p] - (5 - std::sqrt(5.0)) / 20) * std::sqrt(5.0);
    mean += share * Eigen::Map<const Eigen::Vector4d>(&q[4 * (first + p)]);
    v.stress += share * Eigen::Map<const Vec6>(&stress[6 * (first + p)]);
  }
  v.orientation = core::Quaternion(mean[0], mean[1], mean[2], mean[3]).normalized();
  v.pressure = s.end.find("pressure", mesh::Location::element)->values[at.element];
  return v;
}

/// Places that lie in the same grain of every mesh.
std::vector<std::vector<remap::Location>> common_places(const std::vector<Solution>& solutions) {
  std::vector<std::vector<remap::Location>> places;
  std::vector<std::unique_ptr<remap::ElementLocator>> of;
  for (const Solution& s : solutions)
    of.push_back(std::make_unique<remap::ElementLocator>(s.start));
  for (int k = 0; k < samples_along * samples_along * samples_along; ++k) {
    const Vec3 t((k % samples_along + 0.5) / samples_along,
                 (k / samples_along % samples_along + 0.5) / samples_along,
                 (k / samples_along / samples_along + 0.5) / samples_along);
    const Vec3 x = t.cwiseProduct(solutions.front().start.size);
    for (int cell = 0; cell < grains; ++cell) {
      std::vector<remap::Location> here;
      for (const auto& locator : of) {
        here.push_back(locator->find(x, cell));
        if (here.back().excess > 0) break;
      }
      if (here.size() == of.size() && here.back().excess <= 0) places.push_back(here);
    }
  }
  return places;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 7) return 2;
  const auto pool = mesh::MesherPool::start(argv[1]);
  const solver::PetscSession session;
  std::vector<Solution> solutions;
  for (int i = 5; i < argc; ++i) {
    solutions.push_back(
        solve(*pool, argv[2], std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[i])));
    fmt::print("c_l {}: {} elements, von Mises stress of the mean {:.4f} MPa\n", argv[i],
               solutions.back().start.element_count(), solutions.back().stress);
  }
  const auto places = common_places(solutions);
  fmt::print("against the last, at {} places (root mean squares):\n", places.size());
  std::vector<double> last;
  double last_h = 0;
  for (std::size_t k = 0; k + 1 < solutions.size(); ++k) {
    double angle = 0, deviator = 0, pressure = 0;
    for (const auto& place : places) {
      const Values a = values_at(solutions[k], place[k]),
                   b = values_at(solutions.back(), place.back());
      const double turn = core::rotation_angle(a.orientation * b.orientation.conjugate());
      const double difference = von_mises(a.stress - b.stress);
      angle += turn * turn;
      deviator += difference * difference;
      pressure += (a.pressure - b.pressure) * (a.pressure - b.pressure);
    }
    const auto n = static_cast<double>(places.size());
    const double flow = solutions.back().stress;
    const std::vector<double> errors{
        std::abs(solutions[k].stress / flow - 1), std::sqrt(deviator / n) / flow,
        core::degrees_per_radian * std::sqrt(angle / n), std::sqrt(pressure / n) / flow};
    const double h = 1 / std::cbrt(solutions[k].start.element_count());
    fmt::print(
        "{} elements: mean stress {:.4f} %, deviatoric stress {:.3f} %, orientation {:.4f} "
        "degrees, pressure {:.3f} % of the flow stress",
        solutions[k].start.element_count(), 100 * errors[0], 100 * errors[1], errors[2],
        100 * errors[3]);
    for (std::size_t i = 0; i < last.size(); ++i)
      fmt::print("{} {:.2f}", i == 0 ? "; orders" : ",",
                 std::log(last[i] / errors[i]) / std::log(last_h / h));
    fmt::print("\n");
    last = errors;
    last_h = h;
  }
  return 0;
}
