#pragma once
// The interpolation triangles of a face (section 2.1.2.2 of the paper): a fan from a master point
// over the edges of the loop.

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace polyslip::mesh {

/// Master point of a loop of vertices: -1 the barycentre of the vertices, i >= 0 vertex i.
core::Vec3 fan_master(std::span<const core::Vec3> loop, int master);

/// Calls visit(a, b, m) for each interpolation triangle: a, b along the loop, m the master point.
template <class Visit>
void for_each_fan_triangle(std::span<const core::Vec3> loop, int master, Visit&& visit) {
  const core::Vec3 m = fan_master(loop, master);
  const int n = static_cast<int>(loop.size());
  for (int i = 0; i < n; ++i) {
    const int j = i + 1 < n ? i + 1 : 0;
    if (i != master && j != master) visit(loop[i], loop[j], m);
  }
}

/// Vector area of a loop: half the sum of a x b, the same for every master point. Its direction is
/// the mean normal of eq. (3).
core::Vec3 vector_area(std::span<const core::Vec3> loop);

/// Flatness fault as a squared chord: |n_i - n_j|^2 = 4 sin^2(f/2), at most over pairs of triangles
/// (f: the flatness fault). Infinite if a triangle has no area.
double fan_fault(std::span<const core::Vec3> loop, int master);

/// Squared chord of an angle [degrees], and back.
double chord_of_degrees(double degrees);
double degrees_of_chord(double chord);

struct BestFan {
  int master = -1;
  double fault = 0;  ///< squared chord
};
/// The master point of least flatness fault; the barycentre if vertices do no better.
BestFan best_fan(std::span<const core::Vec3> loop);

/// Whether the face is unfolded when projected along its mean normal: the loop is a simple polygon
/// and each interpolation triangle keeps its orientation.
bool unfolded_in_projection(std::span<const core::Vec3> loop, int master);

}  // namespace polyslip::mesh
