#pragma once
// A stored state: one closed HDF5 file that holds a whole Snapshot (so that each can be restarted
// from) and what a user wants of it (element values, displacements). docs/results-format.md.

#include <string>

#include "mesh/snapshot.hpp"

namespace polyslip::results {

/// Writes `path` + ".part", adds the checksum, flushes and renames. Same snapshot, same bytes.
/// InputError if the file cannot be written.
void write_state(const std::string& path, const mesh::Snapshot& snapshot);
/// The same file from an outline, whose fields are read and written piece by piece: what is held of
/// them at a time is a few thousand nodes or elements.
void write_state(const std::string& path, const mesh::Snapshot& outline,
                 const mesh::FieldReader& read);

/// The snapshot that was written, bit for bit. InputError, one line, for a file that is missing,
/// truncated or altered ("... is damaged (...); ..."), of another type or of a newer version.
mesh::Snapshot read_state(const std::string& path);

/// InputError unless the file is whole: length and checksum of every byte.
void verify_state(const std::string& path);

}  // namespace polyslip::results
