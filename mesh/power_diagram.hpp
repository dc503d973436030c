#pragma once
// Laguerre tessellations (power diagrams) as functions of their seeds and weights: measures of the
// cells and their derivatives. Cell i is the part of the domain where |x - x_i|^2 - w_i is least.

#include <array>
#include <vector>

#include "core/types.hpp"
#include "mesh/domain.hpp"
#include "mesh/voronoi_cells.hpp"

namespace polyslip::mesh {

struct PowerFacet {
  int neighbour = 0;  ///< cell, or below zero a domain face (wall_of_neighbour)
  double area = 0;
  core::Vec3 centroid = core::Vec3::Zero();
};

struct PowerVertex {
  core::Vec3 position = core::Vec3::Zero();
  /// Derivative of the cell's surface area by the vertex's position.
  core::Vec3 surface_gradient = core::Vec3::Zero();
  std::array<int, 3> facets{-1, -1, -1};  ///< three facets of the cell that meet there
};

/// Without facets and volume if the domain has no point nearest to the seed.
struct PowerCell {
  double volume = 0, surface = 0;
  core::Vec3 centroid = core::Vec3::Zero();
  std::vector<PowerFacet> facets;
  std::vector<PowerVertex> vertices;

  /// Surface of the sphere of the cell's volume over the cell's surface; 1 for a sphere, 0 for an
  /// empty cell.
  double sphericity() const;
};

/// Seeds in the domain, and a weight for each; a common constant in the weights changes nothing.
struct PowerSeeds {
  std::vector<core::Vec3> positions;
  std::vector<double> weights;
};

std::vector<PowerCell> power_cells(const PowerSeeds& seeds, const Domain& domain);

/// Derivatives of sum_i g_i S_i by the seeds' positions [3 i + k] and weights [i]; S_i: surface of
/// cell i. A vertex x of facets towards cells j, k, l moves by
///   (x_j - x_i) . dx = dx_i . (x - x_i) - dx_j . (x - x_j) + (dw_i - dw_j) / 2, and so on,
/// and stays on the domain's faces.
struct PowerGradient {
  std::vector<double> positions, weights;
};
PowerGradient surface_gradient(const std::vector<PowerCell>& cells, const PowerSeeds& seeds,
                               const Domain& domain, const std::vector<double>& g);

/// Derivative of sum_i g_i V_i by the seeds' positions at fixed weights: facet ij of area A moves
/// outwards at its centroid c by (dx_i . (c - x_i) - dx_j . (c - x_j)) / |x_j - x_i|.
std::vector<double> volume_gradient(const std::vector<PowerCell>& cells, const PowerSeeds& seeds,
                                    const std::vector<double>& g);

}  // namespace polyslip::mesh
