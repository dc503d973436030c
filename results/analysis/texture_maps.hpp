#pragma once
// Densities on grids: for files, and as contoured panels.

#include <array>
#include <string>
#include <vector>

#include "results/analysis/map_figure.hpp"
#include "results/analysis/odf.hpp"
#include "results/analysis/pole_figure.hpp"

namespace polyslip::results::analysis {

/// f on a grid of Bunge's angles [degrees]: phi1 up to 360 (90 with orthorhombic sample symmetry),
/// Phi and phi2 up to 90, both ends included.
struct BungeGrid {
  double step = 5;
  int n1 = 0, n = 0;            ///< places of phi1; of Phi and of phi2
  std::vector<double> density;  ///< [phi2][Phi][phi1]

  double at(int phi1, int Phi, int phi2) const {
    return density[static_cast<std::size_t>((phi2 * n + Phi) * n1 + phi1)];
  }
};
BungeGrid bunge_grid(const Odf& odf, double step = 5, int threads = 0);

/// f on a cubic grid over the cube |r_i| <= sqrt2 - 1 of Rodrigues space, which holds the
/// fundamental region; outside of that |r_1| + |r_2| + |r_3| > 1.
struct RodriguesGrid {
  int n = 0;                    ///< places along each axis, ends included
  std::vector<double> density;  ///< [r3][r2][r1]

  double place(int i) const;  ///< component of the place i
  double at(int i1, int i2, int i3) const {
    return density[static_cast<std::size_t>((i3 * n + i2) * n + i1)];
  }
};
RodriguesGrid rodrigues_grid(const Odf& odf, int n = 33, int threads = 0);

/// f on seven layers of such a grid, evenly across r3, the outermost among them.
struct RodriguesSections {
  static constexpr int count = 7;
  std::array<double, count> r3{};
  int n = 0;                    ///< places along r1 and r2, ends included
  std::vector<double> density;  ///< [section][r2][r1]
};
RodriguesSections rodrigues_sections(const Odf& odf, int n = 33, int threads = 0);
/// The layers of a grid that are nearest.
RodriguesSections sections_of(const RodriguesGrid& grid);

/// A pole figure on a square grid over the unit disc of the equal-area projection, a little beyond.
struct DiscGrid {
  static constexpr double reach = 1.05;
  int n = 0;
  std::vector<double> density;  ///< [y][x]

  double place(int i) const { return reach * (2.0 * i / (n - 1) - 1); }
};
DiscGrid disc_grid(const PoleFigure& figure, int n = 61, int threads = 0);

/// An inverse pole figure on a grid over the standard triangle (equal-area), a little beyond it.
struct TriangleGrid {
  static constexpr double low = -0.02, high_x = 0.56, high_y = 0.48;
  int nx = 0, ny = 0;
  std::vector<double> density;  ///< [y][x]

  double x(int i) const { return low + (high_x - low) * i / (nx - 1); }
  double y(int j) const { return low + (high_y - low) * j / (ny - 1); }
};
TriangleGrid triangle_grid(const InversePoleFigure& figure, int nx = 59, int threads = 0);

/// RD (x) to the right, TD (y) up, ND (z) towards the reader.
MapPanel pole_figure_panel(const DiscGrid& grid, const std::string& title);
MapPanel inverse_pole_figure_panel(const TriangleGrid& grid, const std::string& title);
/// Sections phi2 = 0, 5, ... 90 (of a step of 5), phi1 to the right, Phi downwards.
std::vector<MapPanel> bunge_panels(const BungeGrid& grid);
/// Sections of the fundamental region, with the components that lie near.
std::vector<MapPanel> rodrigues_panels(const RodriguesSections& sections);

}  // namespace polyslip::results::analysis
