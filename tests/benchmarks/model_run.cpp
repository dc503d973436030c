// Plane-strain flow of a real polycrystal (docs/benchmarks.md): grown, regularised, meshed,
// compressed until steps have their full size; then some steps are measured. Prints each step and,
// at the end, iterations, CPU and memory an element, and where the time went.
//   [mpirun -n N] model_run --elements 20000
#include <fmt/core.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

#include "benchmarks/mpi_clock.hpp"
#include "core/timer.hpp"
#include "results/state_file.hpp"
#include "solver/exchange.hpp"
#include "solver/model.hpp"
#include "solver/petsc_session.hpp"
#include "support/crystal_boxes.hpp"
#include "support/polycrystal_mesh.hpp"

namespace {

using namespace polyslip;

struct Request {
  std::string worker = POLYSLIP_BINARY_DIR "/polyslip-mesher";
  double elements = 2450, element_size = 0.5;
  int grains = 0;
  std::uint64_t seed = 1;
  double increment = 0.01;
  int steps = 5;
  double from_strain = 0.025;
  double to_strain = 0;
  int threads = 1;
  double bulk = 0;
  std::string element = "mixed";
  solver::SolverOptions solver;
  double tight = 0;
  std::string save, from;
};

Request read(int argc, char** argv) {
  Request r;
  CLI::App app("Plane-strain flow of a polycrystal, measured");
  app.add_option("--elements", r.elements, "About so many")->capture_default_str();
  app.add_option("--element-size", r.element_size, "For grains of unit volume")
      ->capture_default_str();
  app.add_option("--grains", r.grains, "Instead of --elements");
  app.add_option("--seed", r.seed, "Of the polycrystal")->capture_default_str();
  app.add_option("--increment", r.increment, "Largest step")->capture_default_str();
  app.add_option("--steps", r.steps, "Steps to measure")->capture_default_str();
  app.add_option("--to", r.to_strain, "Measure the whole way to this strain instead");
  app.add_option("--threads", r.threads, "A rank")->capture_default_str();
  app.add_option("--bulk", r.bulk, "Bulk modulus, MPa, at the same shear moduli");
  app.add_option("--element", r.element, "mixed or displacement")->capture_default_str();
  app.add_option("--linear-tolerance", r.solver.linear_tolerance)->capture_default_str();
  app.add_option("--newton-tolerance", r.solver.newton_tolerance)->capture_default_str();
  app.add_option("--tight", r.tight, "One step more, no linear solve looser than this");
  app.add_option("--save", r.save, "Store the state before the measured steps in this file");
  app.add_option("--from", r.from, "Begin with such a state");
  app.add_option("--worker", r.worker, "polyslip-mesher");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  r.solver.element = r.element;
  return r;
}

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  return 0.5 * (v[v.size() / 2] + v[(v.size() - 1) / 2]);
}

/// What was measured in a step.
struct Measured {
  solver::StepRecord step;
  double cpu = 0, slowest = 0, wall = 0;  // s: sum and largest over the ranks; s
};

Measured step(solver::Model& model, double target) {
  Measured m;
  const double cpu = core::process_cpu_seconds(), wall = core::wall_seconds();
  m.step = model.step(target);
  const double mine = core::process_cpu_seconds() - cpu;
  m.cpu = solver::sum(MPI_COMM_WORLD, mine);
  m.slowest = solver::maximum(MPI_COMM_WORLD, mine);
  m.wall = core::wall_seconds() - wall;
  if (tests::on_root(MPI_COMM_WORLD))
    fmt::print(
        "{:.5f} step {:.5f} newton {:2d} linear {:3d} cuts {} cpu {:.2f} s, {:.2f} of a "
        "rank, zz {:.4f} MPa, worst {:.3f}\n",
        m.step.strain, m.step.step_size, m.step.newton_iterations, m.step.linear_iterations,
        m.step.cuts, m.cpu, m.slowest, m.step.stress[2], m.step.min_jacobian_ratio);
  return m;
}

/// Of the measured steps, PETSc's communication included.
void print_communication(const std::vector<Measured>& all) {
  const benchmarks::MpiClock mine = benchmarks::mpi_clock();
  const int ranks = solver::size_of(MPI_COMM_WORLD);
  double s[5] = {mine.cpu, mine.wall, static_cast<double>(mine.messages),
                 static_cast<double>(mine.bytes), static_cast<double>(mine.collectives)};
  solver::sum(MPI_COMM_WORLD, s, 5);
  double cpu = 0, wall = 0;
  for (const Measured& m : all) {
    cpu += m.cpu;
    wall += m.wall;
  }
  const double steps = static_cast<double>(all.size()) * ranks;
  if (tests::on_root(MPI_COMM_WORLD))
    fmt::print(
        "in MPI: {:.1f} % of the CPU, {:.1f} % of the wall time; a rank and step: {:.0f} messages "
        "of {:.0f} bytes, {:.0f} operations of all ranks\n",
        100 * s[0] / cpu, 100 * s[1] / (wall * ranks), s[2] / steps, s[2] > 0 ? s[3] / s[2] : 0,
        s[4] / steps);
}

void print_summary(const std::vector<Measured>& all, int elements, double memory_mb) {
  std::vector<double> cpu, slowest, wall, newton, linear;
  for (const Measured& m : all) {
    cpu.push_back(1e6 * m.cpu / elements);
    slowest.push_back(1e6 * m.slowest / elements);
    wall.push_back(1e6 * m.wall / elements);
    newton.push_back(m.step.newton_iterations);
    linear.push_back(static_cast<double>(m.step.linear_iterations) /
                     std::max(1, m.step.newton_iterations));
  }
  fmt::print(
      "{} elements, median of {} steps: {:.1f} us CPU an element and step (slowest rank {:.1f}, "
      "wall {:.1f}); {:.1f} Newton iterations a step (most {:.0f}), {:.1f} linear a Newton "
      "iteration (most {:.1f}); {:.2f} kB an element at the peak\n",
      elements, all.size(), median(cpu), median(slowest), median(wall), median(newton),
      *std::max_element(newton.begin(), newton.end()), median(linear),
      *std::max_element(linear.begin(), linear.end()), 1e3 * memory_mb / elements);
}

void store(solver::Model& model, const std::string& file) {
  if (file.empty()) return;
  const mesh::Snapshot snapshot = model.snapshot();
  if (tests::on_root(MPI_COMM_WORLD)) results::write_state(file, snapshot);
}

/// An undeformed polycrystal, or a stored state.
mesh::Snapshot begin(const Request& r, mesh::MesherPool& pool, const material::CrystalLaw& law) {
  if (!r.from.empty()) return results::read_state(r.from);
  const int grains = r.grains > 0 ? r.grains : tests::grains_for(r.elements, r.element_size);
  return solver::initial_snapshot(tests::polycrystal_mesh(pool, grains, r.element_size, r.seed),
                                  tests::some_orientations(grains), law);
}

void run(const Request& r, mesh::Snapshot start, const material::CrystalLaw& law, int elements) {
  solver::LoadingOptions loading;
  loading.max_strain_increment = r.increment;
  const auto log = [](const std::string& line) { fmt::print("{}\n", line); };
  solver::Profile profile;
  solver::Model model(MPI_COMM_WORLD, std::move(start), law, loading, r.solver, log, &profile);
  std::vector<Measured> all;
  if (r.to_strain > 0) {
    while (model.strain() < r.to_strain - 1e-9) all.push_back(step(model, r.to_strain));
  } else {
    for (bool grown = false; !grown;)  // a step at least: it sets the solver up
      grown = step(model, 1).step.step_size >= r.increment * (1 - 1e-9) &&
              model.strain() >= r.from_strain;
    store(model, r.save);
    profile.clear();
    benchmarks::mpi_clock() = {};
    for (int i = 0; i < r.steps; ++i) all.push_back(step(model, 1));
  }
  if (all.empty()) return;
  const double memory = solver::sum(MPI_COMM_WORLD, core::peak_rss_mb());
  if (tests::on_root(MPI_COMM_WORLD)) print_summary(all, elements, memory);
  print_communication(all);
  const std::string times = solver::profile_text(profile, MPI_COMM_WORLD);
  if (tests::on_root(MPI_COMM_WORLD)) fmt::print("{}", times);
  double total = 0;
  for (const auto& m : all) total += m.cpu;
  if (tests::on_root(MPI_COMM_WORLD))
    fmt::print("{} steps, {:.2f} CPU s, {:.2f} ms an element and unit strain\n", all.size(), total,
               1e3 * total / elements /
                   (all.back().step.strain - all.front().step.strain + all.front().step.step_size));
  if (r.tight == 0) return;
  solver::SolverOptions tight = r.solver;
  tight.linear_tolerance = 0.05 * r.tight;  // no solve is looser than twenty times this
  solver::Model again(MPI_COMM_WORLD, model.snapshot(), law, loading, tight, log);
  const auto m = step(again, 1);
  if (tests::on_root(MPI_COMM_WORLD))
    fmt::print(
        "at linear tolerances of {:g} at most: {:.1f} linear iterations a Newton iteration\n",
        r.tight, static_cast<double>(m.step.linear_iterations) / m.step.newton_iterations);
}

}  // namespace

int main(int argc, char** argv) {
  const Request r = read(argc, argv);
  const auto pool = mesh::MesherPool::start(r.worker);
  const solver::PetscSession session;
  omp_set_num_threads(r.threads);
  material::MaterialOptions material;
  if (r.bulk > 0) {  // c11 - c12 and c44 stay
    const double shift = r.bulk - (material.c11 + 2 * material.c12) / 3;
    material.c11 += shift;
    material.c12 += shift;
  }
  const auto law = material::make_fcc_law(material);
  mesh::Snapshot start;
  int elements = 0;
  if (tests::on_root(MPI_COMM_WORLD)) {
    start = begin(r, *pool, *law);
    elements = start.mesh.element_count();
    fmt::print("{} grains, {} elements, {} nodes, K = {:.0f} MPa\n",
               start.mesh.topology.cell_count(), elements, start.mesh.node_count(),
               law->bulk_modulus());
  }
  elements = solver::broadcast(MPI_COMM_WORLD, elements);
  run(r, std::move(start), *law, elements);
  return 0;
}
