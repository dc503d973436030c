#pragma once
// A face laid flat, and the way back: projection on its mean plane (section 2.2.1.3, eq. 3, and
// section 2.3.3), or any other map into the plane (mesh/flattening.hpp).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/types.hpp"
#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// Works in the frame of sizes, scaled component by component; positions in and out are unscaled.
/// The shape must outlive it.
class FaceProjection {
 public:
  /// Projection along the mean normal of the frame scaled by `isotropy`, in which faces fold least,
  /// onto the plane there; lengths in the plane are those of the frame of sizes.
  FaceProjection(const FaceShape& shape, const core::Vec3& scale, const core::Vec3& isotropy);
  /// In one frame for both.
  FaceProjection(const FaceShape& shape, const core::Vec3& scale)
      : FaceProjection(shape, scale, scale) {}
  /// By the places of the shape's points in a plane; between them quadratic on each triangle.
  /// Without places nothing projects.
  FaceProjection(const FaceShape& shape, const core::Vec3& scale,
                 std::vector<Eigen::Vector2d> places);

  /// Whether each quarter of each triangle keeps more than `share` of its area in the plane, with
  /// the right sign; of a mean plane in the frame scaled to isotropy.
  bool projects(double share) const;
  /// Largest angle between the normal of a triangle's quarter and the mean normal, radians; frame
  /// scaled to isotropy.
  double distortion() const;
  bool is_mean_plane() const { return mean_plane_; }
  /// Of any position if this is a mean plane; else of one on the face's boundary.
  Eigen::Vector2d project(const core::Vec3& position) const;
  /// Largest extent of the flat face along the axes of its plane.
  double extent() const;
  /// The point of the quadratic surface above p; just outside of it the nearest triangle goes on,
  /// further out it is the nearest point of the surface or its nearest node. `beyond`, if given, is
  /// then set to how far p is from the flat face, else to zero.
  core::Vec3 lift(const Eigen::Vector2d& p, double* beyond = nullptr) const;
  /// The point of the surface nearest to `target` (unscaled distance), sought from above `start`,
  /// which is moved there, but not farther beyond the face; `beyond` as above, of the point found.
  core::Vec3 nearest(const core::Vec3& target, Eigen::Vector2d& start,
                     double* beyond = nullptr) const;
  /// How p changes for a unit step along the surface (frame of sizes) against a gradient; slope:
  /// the part of the gradient along the surface.
  struct Descent {
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    double slope = 0;
  };
  Descent descent(const Eigen::Vector2d& p, const core::Vec3& gradient) const;

 private:
  struct Box {
    Eigen::Vector2d low, high;
  };
  struct BoundarySegment {
    int first, mid, last;  ///< points of the shape
  };
  void find_boxes();
  void find_boundary();
  /// Local coordinates of p on a triangle by Newton's method; the least barycentric coordinate, or
  /// -infinity where there is no solution.
  double invert(int triangle, const Eigen::Vector2d& p, Eigen::Vector2d& xi) const;
  core::Vec3 evaluate(int triangle, const Eigen::Vector2d& xi) const;
  Eigen::Vector2d place(int triangle, const Eigen::Vector2d& xi) const;
  Eigen::Vector2d project_boundary(const core::Vec3& position) const;
  /// Of a quarter (three points): area in the plane over its area.
  double area_share(const std::array<int, 3>& quarter) const;

  const FaceShape* shape_;
  core::Vec3 scale_, isotropy_;
  bool mean_plane_ = true;
  core::Vec3 normal_ = core::Vec3::Zero();  ///< frame scaled to isotropy
  core::Vec3 first_ = normal_, second_ = normal_;
  Eigen::Matrix2d metric_ = Eigen::Matrix2d::Identity();  ///< from (first, second) to the plane
  Eigen::Matrix<double, 3, 2> axes_;        ///< of the plane, frame of sizes; mean plane only
  std::vector<Eigen::Vector2d> projected_;  ///< [shape points]
  std::vector<Box> boxes_;                  ///< [triangles], somewhat enlarged
  std::vector<BoundarySegment> boundary_;   ///< unless it is a mean plane
  double total_share_ = 1;                  ///< area of the flat face over the surface's
};

}  // namespace polyslip::mesh
