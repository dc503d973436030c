#pragma once
// The command line.

#include <optional>
#include <string>

#include "drivers/analyse_verb.hpp"
#include "drivers/report_verb.hpp"
#include "drivers/stats_verb.hpp"

namespace polyslip::drivers {

enum class Verb {
  none,
  run,
  check,
  mesh,
  taylor,
  analyse,
  compare,
  convert,
  stats,
  report,
  reference
};

struct Command {
  Verb verb = Verb::none;
  std::string deck;
  std::string picture;  ///< mesh: file of the picture to write too; empty: none
  bool cut = false;     ///< mesh: whether the picture shows the inside
  std::string out;      ///< --out; for `run` the default is the deck's name and "-run"
  bool overwrite = false;
  std::string restart;   ///< --restart
  int threads = 1;       ///< taylor: 0, all cores
  bool profile = false;  ///< run: --profile
  int jobs = 0;          ///< --jobs; 0: one a core
  std::string folder;    ///< convert: run folder, or a file that becomes `out`
  std::string format;    ///< convert, of `out`; empty: by its extension
  double at_strain = 0;
  std::string to;
  std::string value = "average";
  StatsRequest stats;
  ReportRequest report;
  AnalyseRequest analyse;
  CompareRequest compare;
};

/// What the arguments ask for. Nothing, if they asked for help or the version, which is then
/// printed. Throws InputError, one line, if they cannot be understood.
std::optional<Command> read_command_line(int argc, const char* const* argv);

}  // namespace polyslip::drivers
