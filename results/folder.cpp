#include "results/folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/names.hpp"

namespace polyslip::results {
namespace {

namespace fs = std::filesystem;

constexpr std::array top_names{resolved_deck_name, log_name,           macro_name,   summary_name,
                               xdmf_name,          tessellation_name,  picture_name, report_name,
                               profile_name,       petsc_profile_name, texture_name, spreads_name,
                               regularisation_name};

std::string without_part(std::string name) {
  if (name.ends_with(".part")) name.resize(name.size() - 5);
  return name;
}

bool is_top_file(const std::string& name) {
  return std::find(top_names.begin(), top_names.end(), name) != top_names.end() ||
         number_in(name, "mesh-", ".msh") >= 0 || number_in(name, "mesh-", ".vtu") >= 0 ||
         number_in(name, "mesh-", ".inp") >= 0 || number_in(name, "remeshing-", ".csv") >= 0;
}

bool is_result_file(const std::string& name) {
  return state_number(name) >= 0 || name == index_name;
}

bool is_file_of_analysis(const std::string& name) { return is_analysis_file(name); }

bool is_checkpoint_file(const std::string& name) { return checkpoint_number(name) >= 0; }

bool is_file_of_figures(const std::string& name) { return is_figure_file(name); }

template <class Test>
void collect(const std::string& folder, std::string_view sub, Test is_ours,
             std::vector<std::string>& files) {
  const std::string path = sub.empty() ? folder : in_folder(folder, sub);
  std::error_code error;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (it->is_regular_file() && is_ours(without_part(name)))
      files.push_back(sub.empty() ? name : in_folder(sub, name));
  }
}

/// The folder itself, or the nearest one above it that is there.
std::string existing_folder(const std::string& folder) {
  fs::path path = fs::absolute(folder).lexically_normal();
  std::error_code error;
  while (!fs::exists(path, error) && path != path.root_path()) path = path.parent_path();
  return path.string();
}

}  // namespace

std::vector<std::string> run_files(const std::string& folder) {
  std::vector<std::string> files;
  collect(folder, "", is_top_file, files);
  collect(folder, results_folder, is_result_file, files);
  collect(folder, checkpoints_folder, is_checkpoint_file, files);
  collect(folder, analysis_folder, is_file_of_analysis, files);
  collect(folder, figures_folder, is_file_of_figures, files);
  std::sort(files.begin(), files.end());
  return files;
}

void check_run_folder(const std::string& folder, bool overwrite) {
  const std::string existing = existing_folder(folder);
  if (!fs::is_directory(existing))
    throw core::InputError(fmt::format(
        "{}: {} is a file, not a folder; give another folder with --out", folder, existing));
  core::require_writable_folder(existing);
  for (const auto sub : {results_folder, checkpoints_folder}) {
    const std::string path = in_folder(folder, sub);
    if (!fs::exists(path)) continue;
    if (!fs::is_directory(path))
      throw core::InputError(path + ": is a file where a folder is needed; move it away");
    core::require_writable_folder(path);
  }
  const auto files = run_files(folder);
  if (!files.empty() && !overwrite)
    throw core::InputError(
        fmt::format("{}: holds the results of an earlier run ({} and {} more files); give another "
                    "folder with --out, go on with it by --restart, or replace it with --overwrite",
                    folder, files.front(), files.size() - 1));
}

void check_deck_place(const std::string& folder, const std::string& deck_text, bool overwrite) {
  const std::string path = in_folder(folder, deck_name);
  if (!overwrite && fs::exists(path) && core::read_text(path) != deck_text)
    throw core::InputError(
        path + ": is another deck; give another folder with --out, or replace it with --overwrite");
}

void prepare_run_folder(const std::string& folder, bool overwrite, bool keep_resolved_deck) {
  check_run_folder(folder, overwrite);
  auto files = run_files(folder);
  const auto resolved = std::find(files.begin(), files.end(), resolved_deck_name);
  if (resolved != files.end()) {
    if (keep_resolved_deck)
      files.erase(resolved);
    else
      std::rotate(files.begin(), resolved, resolved + 1);
  }
  for (const auto& file : files) {
    std::error_code error;
    fs::remove(in_folder(folder, file), error);
    if (error)
      throw core::InputError(
          fmt::format("{}: cannot remove: {}", in_folder(folder, file), error.message()));
  }
  core::make_folder(in_folder(folder, results_folder));
  core::make_folder(in_folder(folder, checkpoints_folder));
}

}  // namespace polyslip::results
