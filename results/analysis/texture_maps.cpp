#include "results/analysis/texture_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/rotation.hpp"
#include "results/analysis/components.hpp"

namespace polyslip::results::analysis {
namespace {

using core::Quaternion;
using core::Vec3;

constexpr double edge = std::numbers::sqrt2 - 1;
constexpr int circle_points = 120;

template <class Density>
std::vector<double> on_grid(int nx, int ny, int threads, const Density& density) {
  std::vector<double> values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  core::parallel_for(core::thread_count(threads), values.size(), [&](std::size_t k) {
    values[k] = density(static_cast<int>(k) % nx, static_cast<int>(k) / nx);
  });
  return values;
}

/// |r1| + |r2| <= 1 - |r3| within the square of the cube.
std::vector<Place> rodrigues_outline(double r3) {
  const double reach = 1 - std::abs(r3), corner = reach - edge;
  std::vector<Place> quarter;
  if (corner >= edge)
    quarter = {{edge, edge}};
  else
    quarter = {{edge, corner}, {corner, edge}};
  std::vector<Place> outline;
  for (int turn = 0; turn < 4; ++turn)
    for (const Place& p : quarter) {
      Place q = p;
      for (int i = 0; i < turn; ++i) q = {-q[1], q[0]};
      outline.push_back(q);
    }
  return outline;
}

/// The place i of n between the ends of a cube's edge in Rodrigues space.
double rodrigues_place(int i, int n) {
  return 2 * i == n - 1 ? 0.0 : edge * (2.0 * i / (n - 1) - 1);
}

/// n by n places across r3.
void add_layer(std::vector<Quaternion>& places, int n, double r3) {
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      places.push_back(core::from_rodrigues({rodrigues_place(i, n), rodrigues_place(j, n), r3}));
}

}  // namespace

BungeGrid bunge_grid(const Odf& odf, double step, int threads) {
  BungeGrid g;
  g.step = step;
  g.n = static_cast<int>(std::lround(90 / step)) + 1;
  g.n1 = odf.symmetry() == SampleSymmetry::orthorhombic ? g.n : 4 * (g.n - 1) + 1;
  std::vector<Quaternion> places;
  for (int k = 0; k < g.n; ++k)
    for (int j = 0; j < g.n; ++j)
      for (int i = 0; i < g.n1; ++i)
        places.push_back(core::from_bunge({i * step, j * step, k * step}));
  g.density = odf.at(places, threads);
  return g;
}

double RodriguesGrid::place(int i) const { return rodrigues_place(i, n); }

RodriguesGrid rodrigues_grid(const Odf& odf, int n, int threads) {
  RodriguesGrid g;
  g.n = n;
  std::vector<Quaternion> places;
  for (int k = 0; k < n; ++k) add_layer(places, n, g.place(k));
  g.density = odf.at(places, threads);
  return g;
}

RodriguesSections rodrigues_sections(const Odf& odf, int n, int threads) {
  RodriguesSections s;
  s.n = n;
  std::vector<Quaternion> places;
  for (int k = 0; k < s.count; ++k) {
    s.r3[k] = rodrigues_place(k, s.count);
    add_layer(places, n, s.r3[k]);
  }
  s.density = odf.at(places, threads);
  return s;
}

RodriguesSections sections_of(const RodriguesGrid& grid) {
  RodriguesSections s;
  s.n = grid.n;
  const long layer = static_cast<long>(grid.n) * grid.n;
  for (int section = 0; section < s.count; ++section) {
    const long k = std::lround((grid.n - 1) * section / (s.count - 1.0));
    s.r3[section] = grid.place(static_cast<int>(k));
    s.density.insert(s.density.end(), grid.density.begin() + k * layer,
                     grid.density.begin() + (k + 1) * layer);
  }
  return s;
}

DiscGrid disc_grid(const PoleFigure& figure, int n, int threads) {
  DiscGrid g;
  g.n = n;
  g.density = on_grid(n, n, threads, [&](int i, int j) {
    const Place place(g.place(i), g.place(j));
    // Corners far outside the disc are not shown: the value at its rim will do.
    return figure.at(from_equal_area(place * std::min(1.0, 1.3 / place.norm())));
  });
  return g;
}

TriangleGrid triangle_grid(const InversePoleFigure& figure, int nx, int threads) {
  TriangleGrid g;
  g.nx = nx;
  g.ny = static_cast<int>(std::lround((nx - 1) * (g.high_y - g.low) / (g.high_x - g.low))) + 1;
  g.density = on_grid(g.nx, g.ny, threads, [&](int i, int j) {
    return figure.at(from_equal_area({g.x(i), g.y(j)}));
  });
  return g;
}

MapPanel pole_figure_panel(const DiscGrid& grid, const std::string& title) {
  MapPanel p;
  p.title = title;
  p.columns = p.rows = grid.n;
  p.low = {-grid.reach, -grid.reach};
  p.high = {grid.reach, grid.reach};
  p.values = grid.density;
  for (int i = 0; i < circle_points; ++i) {
    const double angle = 2 * std::numbers::pi * i / circle_points;
    p.outline.emplace_back(std::cos(angle), std::sin(angle));
  }
  p.marks = {{{0.99, 0}, "RD"}, {{0, 0.99}, "TD"}};
  return p;
}

MapPanel inverse_pole_figure_panel(const TriangleGrid& grid, const std::string& title) {
  MapPanel p;
  p.title = title;
  p.columns = grid.nx;
  p.rows = grid.ny;
  p.low = {grid.low, grid.low};
  p.high = {grid.high_x, grid.high_y};
  p.values = grid.density;
  const Vec3 c001(0, 0, 1), c011(1, 0, 1), c111(1, 1, 1);
  p.outline.push_back(equal_area(c001));
  for (int i = 0; i <= 40; ++i)  // the side from [011] to [111] is curved
    p.outline.push_back(equal_area(c011 + i / 40.0 * (c111 - c011)));
  p.marks = {{equal_area(c001), "001"}, {equal_area(c011), "011"}, {equal_area(c111), "111"}};
  return p;
}

std::vector<MapPanel> bunge_panels(const BungeGrid& grid) {
  std::vector<MapPanel> panels;
  const int every = std::max(1, static_cast<int>(std::lround(5 / grid.step)));
  for (int k = 0; k < grid.n; k += every) {
    MapPanel p;
    p.title = fmt::format("phi2 = {:.4g}", k * grid.step);
    p.columns = grid.n1;
    p.rows = grid.n;
    p.low = {0, -90};
    p.high = {(grid.n1 - 1) * grid.step, 0};
    for (int j = grid.n - 1; j >= 0; --j)  // Phi grows downwards
      for (int i = 0; i < grid.n1; ++i) p.values.push_back(grid.at(i, j, k));
    panels.push_back(std::move(p));
  }
  panels.front().below = fmt::format("phi1 to {:.4g}, Phi to 90 down", panels.front().high[0]);
  return panels;
}

std::vector<MapPanel> rodrigues_panels(const RodriguesSections& sections) {
  std::vector<MapPanel> panels;
  const double between = edge * 2 / (sections.count - 1);
  const long layer = static_cast<long>(sections.n) * sections.n;
  for (int s = 0; s < sections.count; ++s) {
    MapPanel p;
    const double r3 = sections.r3[s];
    p.title = fmt::format("r3 = {:.3f}", std::abs(r3) < 1e-9 ? 0.0 : r3);
    p.columns = p.rows = sections.n;
    p.low = {-edge, -edge};
    p.high = {edge, edge};
    p.values.assign(sections.density.begin() + s * layer,
                    sections.density.begin() + (s + 1) * layer);
    p.outline = rodrigues_outline(r3);
    for (const char* name : {"copper", "s", "brass"})
      for (const Component& c : rolling_components())
        if (c.name == name)
          for (const Quaternion& v : c.variants) {
            const Vec3 r = core::fundamental_rodrigues(v);
            if (std::abs(r[2] - r3) < between / 2)
              p.marks.push_back({{r[0], r[1]}, std::string(1, static_cast<char>(name[0] - 32))});
          }
    panels.push_back(std::move(p));
  }
  panels.front().below = "r1 to the right, r2 up";
  return panels;
}

}  // namespace polyslip::results::analysis
