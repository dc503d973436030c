// A polycrystal compressed to a strain: iterations, CPU seconds and balance of each step
// (docs/benchmarks.md). model_run WORKER GRAINS ELEMENT_SIZE STRAIN [MAX_INCREMENT
// [LINEAR_TOLERANCE]]
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "core/rotation.hpp"
#include "mesh/geometry.hpp"
#include "solver/model.hpp"
#include "solver/petsc_session.hpp"
#include "support/crystal_boxes.hpp"

namespace {

using namespace polyslip;

double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

mesh::Mesh polycrystal(mesh::MesherPool& pool, int grains, double element_size) {
  mesh::PolycrystalOptions p;
  p.grains = grains;
  auto tessellation = mesh::voronoi_tessellation(p);
  mesh::regularise(tessellation, {});
  mesh::MeshingOptions options;
  options.element_size = element_size;
  mesh::MeshingReport report;
  return mesh::mesh_geometry(mesh::geometry_of(tessellation), options, {1, 1, 1}, pool, report);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  const auto pool = mesh::MesherPool::start(argv[1]);
  const solver::PetscSession session;
  const auto law = material::make_fcc_law({});
  mesh::Snapshot start;
  const bool root = tests::on_root(MPI_COMM_WORLD);
  if (root) {
    const int grains = std::atoi(argv[2]);
    auto m = polycrystal(*pool, grains, std::atof(argv[3]));
    fmt::print("{} elements, {} nodes\n", m.element_count(), m.node_count());
    start = solver::initial_snapshot(std::move(m), tests::some_orientations(grains), *law);
  }
  solver::LoadingOptions loading;
  solver::SolverOptions options;
  if (argc > 6) options.linear_tolerance = std::atof(argv[6]);
  if (argc > 5) loading.max_strain_increment = std::atof(argv[5]);
  solver::Model model(MPI_COMM_WORLD, start, *law, loading, options,
                      [](const std::string& line) { fmt::print("{}\n", line); });
  const double end = std::atof(argv[4]), begun = cpu();
  int newton = 0, linear = 0, steps = 0;
  while (model.strain() < end) {
    const double before = cpu();
    const auto r = model.step(end);
    newton += r.newton_iterations;
    linear += r.linear_iterations;
    ++steps;
    if (root)
      fmt::print(
          "{:.5f} step {:.5f} newton {:2d} linear {:3d} cpu {:.2f} s zz {:.4f} xx/zz {:.1e} "
          "balance {:.1e} {:.1e} jac {:.3f}\n",
          r.strain, r.step_size, r.newton_iterations, r.linear_iterations, cpu() - before,
          r.stress[2], r.stress[0] / r.stress[2],
          (r.face_forces[4][2] + r.face_forces[5][2]) / r.fz_z1,
          (r.face_forces[2][1] + r.face_forces[3][1]) / r.fz_z1, r.min_jacobian_ratio);
  }
  if (root)
    fmt::print("{} steps, {} Newton, {} linear, {:.1f} s CPU on rank 0\n", steps, newton, linear,
               cpu() - begun);
  return 0;
}
