#pragma once
// Rotations and cubic crystal orientations.
//
// An orientation is the rotation Q that turns crystal axes into sample axes: v_sample = Q
// v_crystal, columns of Q are the crystal axes [100], [010], [001] in the sample frame. As
//   quaternion  (w, x, y, z) = (cos t/2, n sin t/2), of the same rotation (axis n, angle t);
//   Rodrigues   r = n tan t/2, of the same rotation;
//   Bunge       (phi1, Phi, phi2) in degrees: Q = Rz(phi1) Rx(Phi) Rz(phi2), with Rz, Rx
//   right-handed
//               active rotations (Bunge's matrix g, sample to crystal coordinates, is Q^T).
// A crystal symmetry S acts from the right: Q S is the same crystal as Q.

#include <array>
#include <span>

#include "core/types.hpp"

namespace polyslip::core {

inline constexpr double degrees_per_radian = 57.29577951308232088;

/// q or -q, whichever has w > 0 (w = 0: the first non-zero of x, y, z positive).
Quaternion canonical_sign(const Quaternion& q);

/// q or -q, whichever is closer to `reference`.
Quaternion aligned_sign(const Quaternion& q, const Quaternion& reference);

/// Orthogonal matrix of a unit quaternion.
Mat3 to_matrix(const Quaternion& q);
/// Unit quaternion of a rotation matrix (proper, orthogonal to round-off), canonical sign.
Quaternion from_matrix(const Mat3& matrix);

/// n tan t/2; infinite components for t = 180 degrees.
Vec3 to_rodrigues(const Quaternion& q);
Quaternion from_rodrigues(const Vec3& r);

/// (phi1, Phi, phi2) in degrees, phi1 and phi2 in [0, 360), Phi in [0, 180]; for Phi = 0 or 180
/// phi2 = 0.
Vec3 to_bunge(const Quaternion& q);
Quaternion from_bunge(const Vec3& degrees);

/// exp of the skew matrix of `v` [rad]: rotation by |v| about v.
Quaternion exp_axial(const Vec3& v);

/// Rotation angle of q [rad], in [0, pi].
double rotation_angle(const Quaternion& q);

/// The 24 proper rotations of the cube, identity first: every signed permutation of the axes with
/// determinant 1.
const std::array<Quaternion, 24>& cubic_symmetries();

/// The smallest angle [rad] between a and b over all symmetry variants.
double disorientation_angle(const Quaternion& a, const Quaternion& b);

/// The variant q S closest to `reference` in angle, with the sign closest to it too.
Quaternion nearest_variant(const Quaternion& q, const Quaternion& reference);

/// The variant of the smallest angle, w >= 0: its Rodrigues vector lies in the cubic fundamental
/// region, |r_i| <= sqrt2 - 1 and |r_1| + |r_2| + |r_3| <= 1. On the region's surface, where
/// several variants have that angle, the first in the order of `cubic_symmetries`.
Quaternion fundamental_variant(const Quaternion& q);
Vec3 fundamental_rodrigues(const Quaternion& q);

/// The paper's colour (caption of fig. 17): 255 (v_i + sqrt2 - 1) / (2 (sqrt2 - 1)) of the
/// Rodrigues vector v in the fundamental region. Red, green, blue in [0, 255], not rounded.
Vec3 paper_colour(const Quaternion& q);

/// Mean of rotations without symmetry: the eigenvector of the largest eigenvalue of
/// sum_i w_i q_i q_i^T (Markley et al. 2007), so signs do not matter. Its sign is that closest to
/// the first quaternion. `weights` as many as quaternions, or empty for equal ones. Throws
/// InternalError for no quaternions, values that are not finite, or a total weight that is not
/// positive.
Quaternion mean_rotation(std::span<const Quaternion> rotations,
                         std::span<const double> weights = {});

/// Mean of cubic orientations: each is first replaced by its variant nearest to `reference`.
Quaternion mean_orientation(std::span<const Quaternion> orientations, const Quaternion& reference,
                            std::span<const double> weights = {});

}  // namespace polyslip::core
