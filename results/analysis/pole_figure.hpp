#pragma once
// Pole figures and inverse pole figures of cubic crystals, in times random.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "results/analysis/kernel.hpp"
#include "results/analysis/sample.hpp"

namespace polyslip::results::analysis {

/// Directions of the crystal that are alike under cubic symmetry with inversion, of unit length:
/// all signed permutations of `hkl`.
std::vector<core::Vec3> crystal_family(const std::array<int, 3>& hkl);

/// Density of the poles {hkl} over the sphere of sample directions: the kernel's poles about each
/// (docs/texture.md, (T.5)). Its mean over the sphere is 1. A direction and its opposite are alike.
class PoleFigure {
 public:
  PoleFigure(const Sample& sample, const std::array<int, 3>& hkl, double half_width,
             SampleSymmetry symmetry = SampleSymmetry::none);
  ~PoleFigure();
  PoleFigure(PoleFigure&&) noexcept;

  /// direction: of the sample, any length but 0
  double at(const core::Vec3& direction) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Density of a sample direction over the crystal's directions, likewise.
class InversePoleFigure {
 public:
  InversePoleFigure(const Sample& sample, const core::Vec3& sample_direction, double half_width,
                    SampleSymmetry symmetry = SampleSymmetry::none);
  ~InversePoleFigure();
  InversePoleFigure(InversePoleFigure&&) noexcept;

  /// direction: of the crystal, any length but 0
  double at(const core::Vec3& direction) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The crystal direction in the standard triangle [001] [011] [111] that is like `direction`:
/// its components' magnitudes sorted, 0 <= x <= y <= z turned to (y, x, z), so that [011] lies
/// along x: 0 <= y <= x <= z.
core::Vec3 in_standard_triangle(const core::Vec3& direction);

/// Lambert's equal-area projection of the upper hemisphere from below, z up: (x, y) of the unit
/// vector d become (x, y) sqrt(2 / (1 + z)) / sqrt 2, in the unit disc.
Eigen::Vector2d equal_area(const core::Vec3& direction);
/// The upper direction of a place in the unit disc.
core::Vec3 from_equal_area(const Eigen::Vector2d& place);

/// The usual colour of a direction in the standard triangle: red at [001], green at [011], blue at
/// [111]: shares in the basis of the three corners, the largest made 255.
core::Vec3 triangle_colour(const core::Vec3& crystal_direction);
/// Colour of an orientation by the crystal direction along `sample_direction` ("IPF-Z" for z).
core::Vec3 inverse_pole_colour(const core::Quaternion& q, const core::Vec3& sample_direction);

}  // namespace polyslip::results::analysis
