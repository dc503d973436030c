// Keys and tables that a deck has and nobody declared, and what the user may have meant.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/deck.hpp"
#include "core/deck_impl.hpp"

namespace polyslip::core {

namespace {

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::ranges::find(list, item) != list.end();
}

/// "; it belongs in [loading]" for a key that other tables have, else "".
std::string home_advice(const std::vector<Declaration>& declarations, const std::string& key) {
  std::vector<std::string> homes;
  for (const auto& d : declarations)
    if (d.key == key) homes.push_back("[" + d.section + "]");
  return homes.empty() ? "" : fmt::format("; it belongs in {}", fmt::join(homes, " or "));
}

std::string key_advice(const std::vector<Declaration>& declarations,
                       const std::vector<std::string>& keys, const std::string& key) {
  const std::string nearest = nearest_name(key, keys);
  if (!nearest.empty()) return fmt::format("; did you mean '{}'?", nearest);
  const std::string home = home_advice(declarations, key);
  return home.empty() ? fmt::format("; known: {}", fmt::join(keys, ", ")) : home;
}

}  // namespace

std::vector<Deck::Impl::Fault> Deck::Impl::unknown() const {
  std::vector<Fault> faults;
  std::vector<std::string> names;
  for (const auto& [name, help] : sections) names.push_back(name);
  const std::string all_tables = fmt::format("[{}]", fmt::join(names, "], ["));
  for (const auto& [key, at, value] : document.loose) {
    if (contains(names, key)) {
      faults.push_back({at, fmt::format("[{}] must be one table", key)});
      continue;
    }
    std::string advice = home_advice(declarations, key);
    if (advice.empty()) advice = "; keys belong in tables: " + all_tables;
    faults.push_back({at, fmt::format("unknown key '{}'{}", key, advice)});
  }
  for (const auto& table : document.tables) {
    if (contains(names, table.name)) {
      const auto keys = known_keys(table.name);
      for (const auto& [key, at, value] : table.entries)
        if (!contains(keys, key))
          faults.push_back({at, fmt::format("[{}] unknown key '{}'{}", table.name, key,
                                            key_advice(declarations, keys, key))});
      continue;
    }
    const std::string nearest = nearest_name(table.name, names);
    const std::string advice =
        nearest.empty() ? "; known: " + all_tables : fmt::format("; did you mean [{}]?", nearest);
    faults.push_back({table.at, fmt::format("unknown table [{}]{}", table.name, advice)});
  }
  return faults;
}

// Optimal string alignment: the Damerau-Levenshtein distance in which no part is edited twice.
int edit_distance(const std::string& a, const std::string& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (std::size_t i = 0; i <= n; ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= m; ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j) {
      const int cost = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + cost});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

std::string nearest_name(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  int least = std::max(2, static_cast<int>(word.size()) / 3) + 1;
  for (const auto& name : known) {
    const int distance = edit_distance(word, name);
    // Two letters of difference between names of two letters say nothing.
    if (distance < least && distance < static_cast<int>(std::max(word.size(), name.size()))) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

}  // namespace polyslip::core
