#pragma once
// The polycrystal as the page shows it: packed binary blocks of a mesh and of a state.
// docs/report.md lists their layout.

#include <string>

#include "results/report/state_values.hpp"
#include "results/report/surface.hpp"

namespace polyslip::results::report {

/// Triangles (three uint32 each), grains (two uint32 each), lines (a byte each).
std::string mesh_block(const Surface& surface);

/// A box that the positions of a state lie in.
struct Box {
  core::Vec3 low, high;
};
Box box_of(const Surface& surface, const mesh::Mesh& mesh);

/// Positions as uint16 between the corners of the box, x of all nodes, then y, then z; colours of
/// the sides (the paper's, three bytes: the orientation to 0.2 degrees); then of each quantity a
/// uint16 for each side between the least and the greatest value of the state, 65535 for none.
std::string state_block(const Surface& surface, const mesh::Mesh& mesh, const Box& box,
                        const StateValues& values, const std::array<Range, quantity_count>& ranges);

}  // namespace polyslip::results::report
