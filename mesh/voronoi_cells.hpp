#pragma once
// Voronoi and Laguerre cells, each on its own: what the geometry library gives before cells share
// anything.

#include <vector>

#include "core/types.hpp"
#include "mesh/domain.hpp"
#include "mesh/periodicity.hpp"

namespace polyslip::mesh {

/// Neighbour ids below zero are faces of the domain.
constexpr int wall_neighbour(int wall) { return -1 - wall; }
constexpr int wall_of_neighbour(int neighbour) { return -1 - neighbour; }

struct SeparateFace {
  int neighbour = 0;      ///< cell or wall on the other side
  Shift shift{0, 0, 0};   ///< the neighbour is the translate by shift * periods
  std::vector<int> loop;  ///< vertices of the cell, anticlockwise seen from outside
};

struct SeparateCell {
  std::vector<core::Vec3> vertices;
  std::vector<SeparateFace> faces;
};

/// One cell a seed, clipped by the domain and, in periodic directions, by the seeds' translates; it
/// lies around its seed, across the sides of the box. The seeds lie in it. Throws InputError if a
/// seed has no cell (two seeds coincide).
std::vector<SeparateCell> separate_voronoi_cells(const std::vector<core::Vec3>& seeds,
                                                 const Domain& domain);

/// The same for a Laguerre tessellation: cell i is where |x - seed_i|^2 - weight_i is least. A cell
/// that is empty has no faces. Seeds lie in the domain.
std::vector<SeparateCell> separate_power_cells(const std::vector<core::Vec3>& seeds,
                                               const std::vector<double>& weights,
                                               const Domain& domain);

}  // namespace polyslip::mesh
