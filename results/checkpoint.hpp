#pragma once
// Checkpoints of a run folder: state files in checkpoints/, of which the last two are kept.

#include <map>
#include <optional>
#include <string>

#include "mesh/snapshot.hpp"

namespace polyslip::results {

/// Key of the deck's hash in a snapshot's provenance.
inline const std::string deck_hash_key = "deck_hash";

/// Writes checkpoints/checkpoint-<number>.h5 and, once it is there, removes all but this one and
/// the one before, and interrupted writes. InputError if it cannot be written. The fields of the
/// outline are read piece by piece.
void write_checkpoint(const std::string& run_folder, int number, const mesh::Snapshot& outline,
                      const mesh::FieldReader& read);
/// The same of a snapshot that has its fields.
void write_checkpoint(const std::string& run_folder, int number, const mesh::Snapshot& snapshot);

struct CheckpointFile {
  int number = 0;
  std::string path;
};

/// The newest checkpoint, whole and verified; none if there is none (interrupted writes do not
/// count). InputError if the newest is damaged, which a kill cannot do: the line says what is
/// wrong and which files to delete to go back to which older one that is whole. Touches nothing.
std::optional<CheckpointFile> newest_valid_checkpoint(const std::string& run_folder);

/// `read_state`.
mesh::Snapshot read_checkpoint(const std::string& path);

/// InputError unless the snapshot read from `path` was computed with the deck of this hash.
void require_same_deck(const mesh::Snapshot& snapshot, const std::string& path,
                       const std::string& deck_hash);

}  // namespace polyslip::results
