#pragma once
// Random orientations about an ideal one or a fibre. Orientations as in core/rotation.hpp.

#include <optional>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "core/types.hpp"

namespace polyslip::core {

/// The orientation (hkl)[uvw]: the crystal's plane normal hkl lies along z (ND) and its direction
/// uvw along x (RD). A direction that is not in the plane loses its part along the normal. Throws
/// InputError if one is zero or they are parallel.
Quaternion miller_orientation(const Vec3& plane, const Vec3& direction);

/// An ideal orientation of rolled FCC metals: its name and Miller indices.
struct NamedOrientation {
  std::string name;
  Vec3 plane, direction;
};
/// cube (001)[100], goss (011)[100], brass (011)[2-11], copper (112)[-1-11], s (123)[63-4],
/// dillamore (4 4 11)[11 11 -8], rotated-cube (001)[110].
const std::vector<NamedOrientation>& named_orientations();

/// The exponent kappa of de la Vallee Poussin's kernel K(w) ~ cos^(2 kappa)(w/2), w the angle of
/// rotation, that is half its maximum at the angle `half_width` [rad], in (0, pi):
/// kappa = -ln 2 / (2 ln cos(half_width/2)). For narrow ones that is a normal distribution of the
/// rotation vector with the standard deviation half_width / sqrt(2 ln 2) about each axis.
double kernel_exponent(double half_width);

/// A random rotation with the density K, of the exponent kappa > -1/2, relative to uniform ones:
/// sin^2(w/2) has the distribution Beta(3/2, kappa + 1/2), so its mean is 3 / (2 (kappa + 2)); the
/// axis is uniform.
Quaternion random_spread(Random& random, double kappa);

/// A random number of the Gamma distribution of the given shape, at least 1/2, and scale 1
/// (Marsaglia and Tsang 2000).
double random_gamma(Random& random, double shape);

/// Where orientations gather.
struct TextureComponent {
  enum class Kind { uniform, orientation, fibre };
  Kind kind = Kind::uniform;
  Quaternion orientation = Quaternion::Identity();  ///< Kind::orientation: its centre
  Vec3 crystal = Vec3::UnitX();  ///< Kind::fibre: this direction of the crystal lies along ...
  Vec3 sample = Vec3::UnitX();   ///< ... this one of the sample (any lengths but 0)
  double half_width = 0;         ///< [rad] of the kernel about the centre or fibre; 0: none
  bool orthorhombic = false;     ///< half turns about x, y and z make four equal parts
  double share = 1;              ///< of the volume, relative to those of the others
};

/// A random orientation of the component: the centre, or one of the fibre's, all alike, turned by
/// random_spread (in the sample frame). For a fibre the mean cosine between the two directions is
/// then kappa / (kappa + 2).
Quaternion random_orientation(Random& random, const TextureComponent& component);

/// `count` orientations. Each component gets its share of their number, rounded to whole ones by
/// the largest remainders, in random order. Throws InternalError without components or for shares
/// that are not positive.
std::vector<Quaternion> random_texture(Random& random,
                                       const std::vector<TextureComponent>& components, int count);

}  // namespace polyslip::core
