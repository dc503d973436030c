#pragma once
// What is one entity in a periodic polycrystal and several in its body: the union of its whole
// grains, whose outer faces come in pairs of translates.

#include <array>
#include <vector>

#include "core/types.hpp"

namespace polyslip::mesh {

/// Numbers of periods along x, y, z; zero along directions that are not periodic.
using Shift = std::array<int, 3>;

inline Shift operator+(const Shift& a, const Shift& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Shift operator-(const Shift& a, const Shift& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Shift operator-(const Shift& a) { return {-a[0], -a[1], -a[2]}; }
inline bool is_zero(const Shift& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

/// x + shift * periods, component by component. One expression for all, so that translates are the
/// same numbers wherever they are computed.
inline core::Vec3 translated(const core::Vec3& x, const Shift& shift, const core::Vec3& periods) {
  return {x[0] + shift[0] * periods[0], x[1] + shift[1] * periods[1], x[2] + shift[2] * periods[2]};
}

/// The slave is the master, moved by shift * periods.
struct PeriodicPair {
  int slave = -1, master = -1;
  Shift shift{0, 0, 0};
};

/// Sorted by slave; a slave has one master, which is no slave. A slave edge runs as its master. The
/// loop of a slave face is its master's backwards: its vertex k is the master's (n - k) mod n.
struct Periodicity {
  std::vector<PeriodicPair> vertices, edges, faces;
  bool empty() const { return faces.empty(); }
};

/// [count] for each entity its place in `pairs` if it is a slave, else -1.
std::vector<int> pair_of_slave(const std::vector<PeriodicPair>& pairs, int count);

}  // namespace polyslip::mesh
