// The program `polyslip`: verbs, and what becomes of errors.

#include <mpi.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>

#include "core/deck.hpp"
#include "core/error.hpp"
#include "drivers/command_line.hpp"
#include "drivers/convert_file.hpp"
#include "drivers/mesh_verb.hpp"
#include "drivers/options.hpp"
#include "drivers/report_verb.hpp"
#include "drivers/run.hpp"
#include "drivers/stats_verb.hpp"
#include "drivers/taylor.hpp"
#include "results/analysis/orientation_export.hpp"
#include "results/convert.hpp"
#include "solver/petsc_session.hpp"

namespace {

using namespace polyslip;
using drivers::Command;
using drivers::Verb;

/// The rank that the launcher gave this process; 0 without a launcher. Known before MPI starts.
int launched_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"})
    if (const char* value = std::getenv(name)) return std::atoi(value);
  return 0;
}

void say(const std::string& line) {
  if (launched_rank() == 0) std::cerr << line << '\n';
}

std::unique_ptr<mesh::MesherPool> start_pool() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  return mesh::MesherPool::start((program.parent_path() / "polyslip-mesher").string());
}

/// A job of all ranks and its exit code.
int on_ranks(const std::function<int()>& job) {
  const solver::PetscSession session;
  try {
    return job();
  } catch (const core::InputError&) {
    throw;  // on every rank alike
  } catch (const std::exception& e) {
    // One rank may be alone with this: end them all.
    std::cerr << "polyslip: internal error: " << e.what() << '\n';
    MPI_Abort(MPI_COMM_WORLD, drivers::exit_internal_error);
    return drivers::exit_internal_error;
  }
}

int run(const Command& command) {
  const auto pool = start_pool();  // before MPI: it forks
  return on_ranks([&] {
    return drivers::run(MPI_COMM_WORLD,
                        {.deck = command.deck,
                         .folder = command.restart.empty() ? command.out : command.restart,
                         .overwrite = command.overwrite,
                         .restart = !command.restart.empty(),
                         .profile = command.profile,
                         .jobs = command.jobs},
                        *pool);
  });
}

int taylor(const Command& command) {
  return on_ranks([&] {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (command.threads == 0) omp_set_num_threads(std::max(1, omp_get_num_procs() / ranks));
    return drivers::taylor(
        MPI_COMM_WORLD,
        {.deck = command.deck, .folder = command.out, .overwrite = command.overwrite});
  });
}

int check(const Command& command) {
  core::Deck deck = core::Deck::from_file(command.deck);
  drivers::read_options(deck, drivers::Purpose::run);
  std::cout << command.deck << ": fine\n";
  return drivers::exit_fine;
}

int convert(const Command& command) {
  if (!command.out.empty()) {
    std::cout << drivers::convert_file(command.folder, command.out, command.format,
                                       command.overwrite)
              << '\n';
    return drivers::exit_fine;
  }
  const auto value = command.value == "centroid" ? results::ElementValue::centroid
                                                 : results::ElementValue::average;
  const std::string format =
      command.format.empty() ? results::analysis::export_format(command.to) : command.format;
  const auto state = format == "csv" ? results::convert(command.folder, command.at_strain,
                                                        command.to, value, command.overwrite)
                                     : results::analysis::export_orientations(
                                           command.folder, command.at_strain, command.to, format,
                                           command.overwrite);
  std::cout << command.to << ": the state at strain " << state.strain << " (" << state.file
            << ")\n";
  return drivers::exit_fine;
}

int obey(const Command& command) {
  omp_set_num_threads(std::max(1, command.threads));
  switch (command.verb) {
    case Verb::run:
      return run(command);
    case Verb::check:
      return check(command);
    case Verb::mesh:
      drivers::make_mesh(command.deck, command.out, command.overwrite, command.jobs, *start_pool(),
                         command.picture, command.cut);
      return drivers::exit_fine;
    case Verb::taylor:
      return taylor(command);
    case Verb::analyse:
      drivers::analyse(command.analyse);
      return drivers::exit_fine;
    case Verb::compare:
      drivers::compare(command.compare);
      return drivers::exit_fine;
    case Verb::convert:
      return convert(command);
    case Verb::stats:
      drivers::print_statistics(command.stats);
      return drivers::exit_fine;
    case Verb::report:
      std::cout << drivers::write_report(command.report) << '\n';
      return drivers::exit_fine;
    case Verb::reference:
      std::cout << drivers::deck_reference();
      return drivers::exit_fine;
    case Verb::none:
      break;
  }
  return drivers::exit_input_error;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto command = drivers::read_command_line(argc, argv);
    return command ? obey(*command) : drivers::exit_fine;
  } catch (const core::InputError& e) {
    say(e.what());
    return drivers::exit_input_error;
  } catch (const core::RecoverableError& e) {
    say(e.what());
    return drivers::exit_stopped;
  } catch (const std::exception& e) {
    std::cerr << "polyslip: internal error: " << e.what() << '\n';
    return drivers::exit_internal_error;
  }
}
