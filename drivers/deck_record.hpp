#pragma once
// The decks in a run folder: as given, and as understood.

#include <string>

namespace polyslip::drivers {

/// Writes deck.toml and then deck.resolved.toml, whose first line says of which text it was made:
/// once it is there, there is a run to restart. InputError if they cannot be written.
void write_decks(const std::string& folder, const std::string& given, const std::string& resolved);

/// InputError unless the folder's deck.resolved.toml was made of its deck.toml as it is now (a run
/// that has no checkpoint yet knows its deck from there). Touches nothing.
void require_unedited_deck(const std::string& folder);

}  // namespace polyslip::drivers
