#pragma once
// Projection of a face on its mean plane and back (section 2.2.1.3, eq. 3, and section 2.3.3).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/types.hpp"
#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// Works in the frame scaled component by component; positions in and out are unscaled.
class FaceProjection {
 public:
  FaceProjection(const FaceShape& shape, const core::Vec3& scale);

  /// Eq. (3), of the straight triangles, scaled frame.
  const core::Vec3& normal() const { return normal_; }
  /// Whether each quarter of each triangle keeps more than `share` of its area in the projection,
  /// with the right sign.
  bool projects(double share) const;
  /// Largest angle between the normal of a triangle's quarter and the mean normal, radians.
  double distortion() const;
  Eigen::Vector2d project(const core::Vec3& position) const;
  /// Largest extent of the projected face along the axes of its plane.
  double extent() const;
  /// The point of the quadratic surface above p; just outside of it the nearest triangle goes on,
  /// further out it is the nearest point of the surface or its nearest node. `beyond`, if given, is
  /// then set to how far p is from its projection, else to zero.
  core::Vec3 lift(const Eigen::Vector2d& p, double* beyond = nullptr) const;
  /// The point of the surface nearest to `target` (unscaled distance), sought from above `start`;
  /// `beyond` as above, of the point found.
  core::Vec3 nearest(const core::Vec3& target, const Eigen::Vector2d& start,
                     double* beyond = nullptr) const;

 private:
  struct Box {
    Eigen::Vector2d low, high;
  };
  /// Local coordinates of p on a triangle by Newton's method; the least barycentric coordinate, or
  /// -infinity where there is no solution.
  double invert(int triangle, const Eigen::Vector2d& p, Eigen::Vector2d& xi) const;
  core::Vec3 evaluate(int triangle, const Eigen::Vector2d& xi) const;

  const FaceShape* shape_;
  core::Vec3 scale_, normal_, first_, second_;  ///< unit vectors of the scaled frame
  std::vector<Eigen::Vector2d> projected_;      ///< [shape points]
  std::vector<Box> boxes_;                      ///< [triangles], somewhat enlarged
};

}  // namespace polyslip::mesh
