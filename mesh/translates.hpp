#pragma once
// Entities of a periodic polycrystal with their translates.

#include <vector>

#include "mesh/periodicity.hpp"

namespace polyslip::mesh {

/// A translate of an entity: `entity` is where the one it is of is, moved by shift * periods.
struct Translate {
  int entity = -1;
  Shift shift{0, 0, 0};
};

/// [count] for each entity itself and its slaves; nothing for slaves.
inline std::vector<std::vector<Translate>> translates(const std::vector<PeriodicPair>& pairs,
                                                      int count) {
  std::vector<std::vector<Translate>> lists(count);
  for (int i = 0; i < count; ++i) lists[i].push_back({i, {0, 0, 0}});
  for (const auto& pair : pairs) {
    lists[pair.slave].clear();
    lists[pair.master].push_back({pair.slave, pair.shift});
  }
  return lists;
}

}  // namespace polyslip::mesh
