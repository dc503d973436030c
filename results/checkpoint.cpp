#include "results/checkpoint.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "core/file.hpp"
#include "results/names.hpp"
#include "results/state_file.hpp"

namespace polyslip::results {
namespace {

namespace fs = std::filesystem;

/// Whole checkpoints by number.
std::map<int, std::string> checkpoints_in(const std::string& run_folder) {
  std::map<int, std::string> found;
  const std::string folder = in_folder(run_folder, checkpoints_folder);
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const int number = checkpoint_number(it->path().filename().string());
    if (number >= 0) found[number] = it->path().string();
  }
  return found;
}

/// What is wrong with a checkpoint; empty if it is whole.
std::string fault_of(const std::string& path) {
  try {
    verify_state(path);
    return {};
  } catch (const core::InputError& error) {
    std::string what = error.what();
    what.resize(std::min(what.size(), what.find(';')));
    return what;
  }
}

void remove_parts(const std::string& run_folder) {
  std::vector<fs::path> parts;
  for (const auto& entry : fs::directory_iterator(in_folder(run_folder, checkpoints_folder)))
    if (entry.path().filename().string().ends_with(".h5.part")) parts.push_back(entry.path());
  for (const auto& part : parts) fs::remove(part);
}

}  // namespace

void write_checkpoint(const std::string& run_folder, int number, const mesh::Snapshot& snapshot) {
  write_checkpoint(run_folder, number, snapshot, mesh::reader_of(snapshot));
}

void write_checkpoint(const std::string& run_folder, int number, const mesh::Snapshot& outline,
                      const mesh::FieldReader& read) {
  const std::string folder = in_folder(run_folder, checkpoints_folder);
  core::make_folder(folder);
  write_state(in_folder(folder, checkpoint_name(number)), outline, read);
  remove_parts(run_folder);
  auto all = checkpoints_in(run_folder);
  // Later ones are of a run that was taken up before them: what follows no longer belongs to them.
  for (auto later = all.upper_bound(number); later != all.end(); later = all.erase(later))
    fs::remove(later->second);
  while (all.size() > 2) {
    fs::remove(all.begin()->second);
    all.erase(all.begin());
  }
}

std::optional<CheckpointFile> newest_valid_checkpoint(const std::string& run_folder) {
  const auto all = checkpoints_in(run_folder);
  if (all.empty()) return std::nullopt;
  const auto& [number, path] = *all.rbegin();
  const std::string fault = fault_of(path);
  if (fault.empty()) return CheckpointFile{number, path};
  std::string files = "this file";
  for (auto older = std::next(all.rbegin()); older != all.rend(); ++older) {
    if (fault_of(older->second).empty())
      throw core::InputError(fmt::format("{}; delete {} to restart from {}, which is intact", fault,
                                         files, older->second));
    files += " and " + older->second + ", which is damaged too,";
  }
  throw core::InputError(fmt::format("{}; delete {} to start over", fault, files));
}

mesh::Snapshot read_checkpoint(const std::string& path) { return read_state(path); }

void require_same_deck(const mesh::Snapshot& snapshot, const std::string& path,
                       const std::string& deck_hash) {
  const auto stored = snapshot.provenance.find(deck_hash_key);
  const std::string hash = stored == snapshot.provenance.end() ? "none" : stored->second;
  if (hash != deck_hash)
    throw core::InputError(
        fmt::format("{}: checkpoint of another deck (its hash is {}, this deck's {}); restore the "
                    "deck of that run or start a new one with --out",
                    path, hash, deck_hash));
}

}  // namespace polyslip::results
