#pragma once
// The stored states of a run folder: files, index, and the XDMF file made of the index.

#include <string>
#include <vector>

#include "mesh/snapshot.hpp"
#include "results/orientation_state.hpp"
#include "results/xdmf.hpp"

namespace polyslip::results {

/// Order of writing: the state's file, the index, the XDMF file; each is whole or not there. A
/// kill in between leaves at most a file that no index names, which the next state replaces.
class StateSeries {
 public:
  /// A run folder with its results/ folder; the index is read if there is one (InputError if it
  /// cannot be understood). Touches nothing.
  explicit StateSeries(std::string run_folder);

  /// Stores the next state: results/state-<n>.h5. InputError if it cannot be written.
  const StateRecord& store(const mesh::Snapshot& snapshot);
  /// The same from an outline, whose fields are read piece by piece.
  const StateRecord& store(const mesh::Snapshot& outline, const mesh::FieldReader& read);
  /// The same for orientations without a mesh; there is no XDMF file of such states.
  const StateRecord& store(const OrientationState& state);
  /// InputError if there are fewer states, or one of their files is missing. Touches nothing.
  void require_first(std::size_t count) const;
  /// `require_first`, then keeps the first `count` states; deletes the files of later ones and of
  /// interrupted writes, and rewrites the XDMF file.
  void keep_first(std::size_t count);
  /// The same, keeping the states up to and including `strain` (and its far side of a remeshing).
  void trim_after(double strain);

  const std::vector<StateRecord>& states() const { return states_; }
  /// Whether the states are those of a Taylor model: orientations without a mesh.
  bool without_mesh() const { return !states_.empty() && states_.front().mesh_number < 0; }
  std::string path(const StateRecord& state) const;

 private:
  void write_index() const;
  std::string folder_;
  std::vector<StateRecord> states_;
};

/// The states of a run that has stored some; InputError, which names the folder, if there is none.
StateSeries begun_series(const std::string& run_folder);

/// The state nearest in strain; of two at the same strain (both sides of a remeshing) the first.
/// InputError if the run has none.
const StateRecord& nearest_state(const StateSeries& series, double strain);

}  // namespace polyslip::results
