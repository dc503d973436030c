#pragma once
// Rules of a run folder: an earlier run is never written over unless asked.

#include <string>
#include <vector>

namespace polyslip::results {

/// Paths, relative to the folder, of what a run wrote there (interrupted writes too), sorted. The
/// deck itself is not among them: it may be the user's own.
std::vector<std::string> run_files(const std::string& folder);

/// Touches nothing that lasts. InputError, one line, if `folder` holds an earlier run and
/// `overwrite` is false (the line names --overwrite), is not a folder, or it, or the folder in
/// which it has to be made, cannot be written to.
void check_run_folder(const std::string& folder, bool overwrite);

/// InputError if the folder has a deck.toml of another text, which may be the user's own, and
/// `overwrite` is false. Touches nothing.
void check_deck_place(const std::string& folder, const std::string& deck_text, bool overwrite);

/// `check_run_folder`, then removes what an earlier run wrote (only such files: others stay) and
/// makes the folder with results/ and checkpoints/. deck.resolved.toml, without which there is
/// nothing to restart, goes first; a run that starts over may keep it.
void prepare_run_folder(const std::string& folder, bool overwrite, bool keep_resolved_deck = false);

}  // namespace polyslip::results
