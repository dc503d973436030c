#pragma once
// Maps of faces that do not project on a plane into one (docs/theory-polycrystal.md, section 4).

#include <Eigen/Core>
#include <vector>

#include "core/types.hpp"
#include "mesh/geometry.hpp"

namespace polyslip::mesh {

/// Places of a face's points in the plane by the least-squares conformal map (B. Levy, S.
/// Petitjean, N. Ray, J. Maillot, ACM Trans. Graph. 21, 2002): of its six-node triangles' quarters,
/// frame scaled component by component, with the area of the face there. It has almost no
/// distortion but may fold; any number of loops. Empty if there is none.
std::vector<Eigen::Vector2d> conformal_places(const FaceShape& shape, const core::Vec3& scale);

/// The same with the longest loop of the boundary on a circle, by its lengths, and the other
/// corners of the triangles in the mean of their neighbours with mean-value weights (M. S. Floater,
/// Comput. Aided Geom. Des. 20, 2003): it cannot fold, but distorts. Other loops are closed for
/// that with a lid. Mid nodes lie amid the corners, so that each triangle is flat and linear: with
/// those of the boundary on the circle a triangle with two sides there would have no area at the
/// corner between them. Empty for loops that meet.
std::vector<Eigen::Vector2d> circle_places(const FaceShape& shape, const core::Vec3& scale);

}  // namespace polyslip::mesh
