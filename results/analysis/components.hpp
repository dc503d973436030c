#pragma once
// Ideal orientations of rolled FCC metals in a texture, and the beta-fibre.

#include <string>
#include <vector>

#include "results/analysis/odf.hpp"

namespace polyslip::results::analysis {

/// An ideal orientation with its variants under half turns about x, y and z.
struct Component {
  std::string name;                        ///< of core::named_orientations
  std::vector<core::Quaternion> variants;  ///< those that differ by more than crystal symmetry
};

/// cube, goss, brass, s, copper, dillamore ({4 4 11}<11 11 -8>, "D"), rotated-cube.
const std::vector<Component>& rolling_components();

/// Mean of f over the component's variants, in times random.
double intensity(const Odf& odf, const Component& component);

/// Share of the weight within `angle` [rad] of a variant; orientations at the same distance of two
/// count once.
double volume_fraction(const Sample& sample, const Component& component, double angle);

/// Of random orientations, without overlap of variants: variants (24/pi) (angle - sin(angle)).
double random_volume_fraction(const Component& component, double angle);

/// A place on the beta-fibre, which runs from copper (phi2 = 45) through s to brass (phi2 = 90).
struct FibrePoint {
  double phi2 = 0;             ///< degrees
  core::Vec3 ideal;            ///< Bunge, degrees: between the ideal orientations
  double ideal_intensity = 0;  ///< f there, mean of the variants
  core::Vec3 ridge;            ///< where f is largest in the section, within 15 degrees of `ideal`
  double ridge_intensity = 0;  ///< f there
};

/// The curve at phi2 = 45, 50, ... 90. The ideal places are linear in Bunge's angles between copper
/// (90, 35.26, 45), s (58.98, 36.70, 63.43) and brass (35.26, 45, 90). f is the mean over the
/// half turns of the sample, as the fibre has four variants.
std::vector<FibrePoint> beta_fibre(const Odf& odf, int threads = 0);

}  // namespace polyslip::results::analysis
