#pragma once
// Inside of core::Deck, shared by deck.cpp (reading) and deck_output.cpp (writing).

#include <string>
#include <utility>
#include <vector>

#include "core/deck.hpp"
#include "core/toml.hpp"

namespace polyslip::core {

struct Deck::Impl {
  struct Fault {
    Position at;
    std::string what;
  };

  std::string path, text;
  TomlDocument document;
  std::vector<std::pair<std::string, std::string>> sections;  ///< name and sentence, as declared
  std::vector<Declaration> declarations;
  std::vector<Fault> key_faults;    ///< of single keys
  std::vector<Fault> cross_faults;  ///< between keys

  const TomlTable* find_table(const std::string& section) const;
  const TomlEntry* find(const std::string& section, const std::string& key) const;
  std::vector<std::string> known_keys(const std::string& section) const;
  Position place(const std::string& section, const std::string& key) const;
  std::string place_text(Position at) const;
  /// Notes "[section] what".
  void key_fault(Position at, const std::string& section, const std::string& what);
  /// Faults of what the text has and nobody declared.
  std::vector<Fault> unknown() const;
};

}  // namespace polyslip::core
