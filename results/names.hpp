#pragma once
// Names of the files in a run folder.

#include <string>
#include <string_view>

namespace polyslip::results {

/// `<prefix><number, at least `digits` wide><suffix>`
std::string numbered(std::string_view prefix, int number, int digits, std::string_view suffix);
/// The number in such a name, -1 if `name` is none.
int number_in(std::string_view name, std::string_view prefix, std::string_view suffix);

/// "state-0000.h5", in results/
inline std::string state_name(int number) { return numbered("state-", number, 4, ".h5"); }
inline int state_number(std::string_view name) { return number_in(name, "state-", ".h5"); }
/// "checkpoint-0000.h5", in checkpoints/
inline std::string checkpoint_name(int number) { return numbered("checkpoint-", number, 4, ".h5"); }
inline int checkpoint_number(std::string_view name) {
  return number_in(name, "checkpoint-", ".h5");
}
/// "mesh-000.msh"
inline std::string mesh_name(int number, std::string_view extension = ".msh") {
  return numbered("mesh-", number, 3, extension);
}
/// "remeshing-001.csv", by the number of the new mesh
inline std::string remeshing_name(int number) { return numbered("remeshing-", number, 3, ".csv"); }
/// "mesh-000-periodic.csv"
inline std::string periodic_name(int number) {
  return numbered("mesh-", number, 3, "-periodic.csv");
}

inline constexpr std::string_view results_folder = "results";
inline constexpr std::string_view checkpoints_folder = "checkpoints";
inline constexpr std::string_view deck_name = "deck.toml";
inline constexpr std::string_view resolved_deck_name = "deck.resolved.toml";
inline constexpr std::string_view log_name = "log.txt";
inline constexpr std::string_view macro_name = "macro.csv";
inline constexpr std::string_view summary_name = "summary.json";
inline constexpr std::string_view profile_name = "profile.txt";
inline constexpr std::string_view petsc_profile_name = "profile-petsc.txt";
inline constexpr std::string_view xdmf_name = "results.xdmf";
inline constexpr std::string_view index_name = "index.json";  // in results/
inline constexpr std::string_view tessellation_name = "polycrystal.tess";
inline constexpr std::string_view regularisation_name = "regularisation.json";
inline constexpr std::string_view picture_name = "polycrystal.png";
inline constexpr std::string_view report_name = "report.html";
inline constexpr std::string_view figures_folder = "figures";  // of the report
/// Whether a file of this name in the figures folder is polyslip's.
bool is_figure_file(std::string_view name);
// of polyslip analyse
inline constexpr std::string_view texture_name = "texture.csv";
inline constexpr std::string_view spreads_name = "spreads.csv";
inline constexpr std::string_view analysis_folder = "analysis";
/// Whether a file of this name in the analysis folder is polyslip's.
bool is_analysis_file(std::string_view name);

/// folder + "/" + name
inline std::string in_folder(std::string_view folder, std::string_view name) {
  return std::string(folder).append("/").append(name);
}

}  // namespace polyslip::results
