#include "drivers/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "core/version.hpp"

namespace polyslip::drivers {
namespace {

void add_deck(CLI::App& verb, Command& c) {
  verb.add_option("deck", c.deck, "Deck (TOML; docs/deck.md)")->required();
}

void add_threads(CLI::App& verb, Command& c) {
  verb.add_option("--threads", c.threads, "OpenMP threads of a rank")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void add_jobs(CLI::App& verb, Command& c) {
  verb.add_option(
          "--jobs", c.jobs,
          "Mesher processes and threads of meshing (default: one a core); the mesh does not "
          "depend on it")
      ->check(CLI::Range(1, 1024));
}

void add_overwrite(CLI::App& verb, Command& c, const char* what) {
  verb.add_flag("--overwrite", c.overwrite, what);
}

void add_run(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand("run", "Grow, mesh, deform and remesh a polycrystal");
  CLI::Option* deck = verb->add_option("deck", c.deck, "Deck (TOML; docs/deck.md)");
  CLI::Option* out =
      verb->add_option("--out", c.out, "Run folder (default: the deck's name and \"-run\", here)");
  verb->add_option("--restart", c.restart, "Go on with the run in this folder")
      ->excludes(deck)
      ->excludes(out);
  add_overwrite(*verb, c, "Replace an earlier run in the folder");
  add_threads(*verb, c);
  add_jobs(*verb, c);
  verb->add_flag("--profile", c.profile,
                 "Say at the end where the deformation's time went, stage by stage (profile.txt, "
                 "and PETSc's own log in profile-petsc.txt)");
  verb->callback([&c] {
    c.verb = Verb::run;
    if (c.deck.empty() && c.restart.empty())
      throw CLI::ValidationError("run", "a deck, or --restart DIR, is required");
    if (!c.restart.empty() && c.overwrite)
      throw CLI::ValidationError("run", "--restart goes on with a run; it cannot --overwrite it");
    if (c.out.empty() && c.restart.empty())
      c.out = std::filesystem::path(c.deck).stem().string() + "-run";
  });
}

void add_check(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand("check", "Check a deck; touches no file");
  add_deck(*verb, c);
  verb->callback([&c] { c.verb = Verb::check; });
}

void add_mesh(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand("mesh", "Grow and mesh a polycrystal only");
  add_deck(*verb, c);
  verb->add_option("--out", c.out, "Folder")->required();
  CLI::Option* picture =
      verb->add_option("--picture", c.picture, "Picture of the mesh to write too (PNG)");
  verb->add_flag("--cut", c.cut,
                 "Show the inside in the picture: leave out an eighth of the grains")
      ->needs(picture);
  add_overwrite(*verb, c, "Replace an earlier run in the folder");
  add_threads(*verb, c);
  add_jobs(*verb, c);
  verb->callback([&c] { c.verb = Verb::mesh; });
}

void add_taylor(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand("taylor",
                                      "The Taylor model of a deck: no mesh, each crystal "
                                      "deforms as the whole");
  add_deck(*verb, c);
  verb->add_option("--out", c.out, "Folder (default: the deck's name and \"-taylor\", here)");
  add_overwrite(*verb, c, "Replace an earlier run in the folder");
  CLI::Option* threads =
      verb->add_option("--threads", c.threads, "OpenMP threads of a rank (default: all cores)")
          ->check(CLI::Range(1, 1024));
  verb->callback([&c, threads] {
    c.verb = Verb::taylor;
    if (threads->count() == 0) c.threads = 0;
    if (c.out.empty()) c.out = std::filesystem::path(c.deck).stem().string() + "-taylor";
  });
}

/// Options that analyse and compare share.
void add_texture_options(CLI::App& verb, AnalyseRequest& a) {
  verb.add_option("--half-width", a.half_width,
                  "Of the kernel, degrees (default: the deck's, else 10)")
      ->check(CLI::Range(3.0, 90.0));
  verb.add_option("--sample-symmetry", a.sample_symmetry, "none or orthorhombic")
      ->check(CLI::IsMember({"none", "orthorhombic"}));
  verb.add_option("--at-strains", a.at_strains, "Only the states nearest to these strains")
      ->delimiter(',');
  verb.add_flag("--inner", a.inner, "Only grains without a face on the domain boundary");
  verb.add_option("--threads", a.threads, "Threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
}

void add_compare(CLI::App& app, Command& c) {
  CompareRequest& r = c.compare;
  CLI::App* verb = app.add_subcommand("compare", "A run and the Taylor model side by side");
  verb->add_option("run", r.run, "Folder of polyslip run")->required();
  verb->add_option("taylor", r.taylor, "Folder of polyslip taylor")->required();
  verb->add_option("--to", r.to, "Folder for the files (default: the run's)");
  add_texture_options(*verb, r.how);
  verb->add_flag("--overwrite", r.how.overwrite, "Replace an earlier comparison");
  verb->callback([&c] { c.verb = Verb::compare; });
}

void add_analyse(CLI::App& app, Command& c) {
  AnalyseRequest& a = c.analyse;
  CLI::App* verb =
      app.add_subcommand("analyse", "Texture and in-grain spreads: tables (CSV) and figures (SVG)");
  verb->add_option("input", a.input,
                   "Folder of polyslip run or taylor, or a file of orientations, one a line")
      ->required();
  verb->add_option("--to", a.to, "Folder for the files (default: the input's own)");
  add_texture_options(*verb, a);
  verb->add_option("--convention", a.convention,
                   "Of a file: quaternion (w x y z), rodrigues, euler-bunge (degrees); a further "
                   "column is a weight")
      ->check(CLI::IsMember({"quaternion", "rodrigues", "euler-bunge"}));
  verb->add_option("--grains", a.grains, "Grains to draw paths and spreads of (from 1)")
      ->delimiter(',');
  verb->add_flag("--one-mode", a.one_mode, "Spreads: only grains of one mode");
  verb->add_flag("--all-maps", a.all_maps, "Sections of the ODF at every state, not the last only");
  verb->add_flag("--overwrite", a.overwrite, "Replace an earlier analysis");
  verb->callback([&c] { c.verb = Verb::analyse; });
}

void add_convert(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand(
      "convert", "Write a tessellation or mesh in another format, or a stored state as a table");
  verb->add_option("in", c.folder, "File (.tess, .msh; .gz too), or run folder")->required();
  verb->add_option("out", c.out, "File to write: .tess, .msh, .vtu, .inp");
  verb->add_option("--format", c.format,
                   "Of the file: msh, msh-binary (Gmsh 2.2), msh4, msh4-binary (4.1), vtu, inp "
                   "(Abaqus), tess; of a state: csv, mtex, ori; default: by the "
                   "extension, csv for states");
  CLI::Option* strain = verb->add_option(
      "--at-strain", c.at_strain, "Of a run folder: the stored state nearest to this strain");
  verb->add_option("--to", c.to,
                   "File for the state: a table of elements (.csv), or its orientations for "
                   "Neper (.ori) or MTEX (--format mtex)");
  verb->add_option("--value", c.value, "Averages of elements, or values at their centroids")
      ->check(CLI::IsMember({"average", "centroid"}))
      ->capture_default_str();
  add_overwrite(*verb, c, "Replace a file that is there");
  verb->callback([&c, strain] {
    c.verb = Verb::convert;
    const bool state = strain->count() > 0 && !c.to.empty();
    const bool none = strain->count() == 0 && c.to.empty();
    const bool known =
        c.format.empty() || c.format == "csv" || c.format == "mtex" || c.format == "ori";
    if (c.out.empty() ? !state || !known : !none)
      throw CLI::ValidationError("convert",
                                 "give a file to read and one to write, or a run folder with "
                                 "--at-strain and --to");
  });
}

void add_stats(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand(
      "stats", "Statistics of a tessellation, a mesh, or a folder of run or mesh");
  verb->add_option("input", c.stats.input, "File (.tess, .msh, .gz too) or folder")->required();
  verb->add_option("--to", c.stats.to, "Folder for stats.json, tables (CSV) and plots (SVG)");
  verb->add_flag("--inner", c.stats.inner, "Only grains without a face on the domain boundary");
  verb->add_option("--element-size", c.stats.element_size,
                   "Element size that was asked for, for grains of unit mean volume (default: the "
                   "deck's, else the mean element's)")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--overwrite", c.stats.overwrite, "Replace earlier statistics in the folder");
  verb->callback([&c] { c.verb = Verb::stats; });
}

void add_report(CLI::App& app, Command& c) {
  CLI::App* verb = app.add_subcommand("report", "Show a run in one HTML file, report.html");
  verb->add_option("folder", c.report.folder, "Run folder")->required();
  verb->add_option("--taylor", c.report.taylor,
                   "Folder of a Taylor model of the same load (polyslip taylor), shown beside");
  verb->add_flag("--overwrite", c.report.overwrite, "Replace a report.html that is none of ours");
  verb->callback([&c] { c.verb = Verb::report; });
}

void add_reference(CLI::App& app, Command& c) {
  app.add_subcommand("reference", "Print the deck reference (docs/deck.md)")->callback([&c] {
    c.verb = Verb::reference;
  });
}

std::string one_line(std::string text) {
  for (char& character : text)
    if (character == '\n') character = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// The first argument is a verb, or an option of the program.
void require_verb(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string verbs;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (verb->get_name() == argv[1]) return;
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
  }
  throw core::InputError(
      fmt::format("polyslip: unknown verb '{}'; there are {} (polyslip --help)", argv[1], verbs));
}

}  // namespace

std::optional<Command> read_command_line(int argc, const char* const* argv) {
  Command command;
  CLI::App app(
      "From random polycrystal to deformed texture: Voronoi, meshing, crystal-plasticity "
      "finite elements, remeshing.",
      "polyslip");
  app.set_version_flag("--version", "polyslip " + core::version());
  app.require_subcommand(1);
  add_run(app, command);
  add_check(app, command);
  add_mesh(app, command);
  add_taylor(app, command);
  add_analyse(app, command);
  add_compare(app, command);
  add_convert(app, command);
  add_stats(app, command);
  add_report(app, command);
  add_reference(app, command);
  require_verb(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    app.exit(success, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw core::InputError("polyslip: " + one_line(error.what()) + " (polyslip --help)");
  }
  return command;
}

}  // namespace polyslip::drivers
