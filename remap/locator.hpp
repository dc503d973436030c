#pragma once
// Finds the element of a mesh that holds a point, within a grain.

#include <memory>

#include "core/types.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::remap {

/// Where a point lies.
struct Location {
  int element = -1;
  core::Vec3 xi = core::Vec3::Zero();  ///< local coordinates in the element
  double excess = 0;  ///< how far the smallest barycentric coordinate lies below zero; 0 inside
};

/// Local coordinates of `point` in a ten-node element, by Newton's method on the quadratic map from
/// the solution of the straight tetrahedron. Excess is infinite if the iteration does not converge.
Location locate_in_element(const mesh::Mesh& mesh, int element, const core::Vec3& point);

/// A tree of element centroids for each grain.
class ElementLocator {
 public:
  /// Keeps a reference to `mesh` (order 2).
  explicit ElementLocator(const mesh::Mesh& mesh);
  ~ElementLocator();
  ElementLocator(const ElementLocator&) = delete;
  ElementLocator& operator=(const ElementLocator&) = delete;

  /// The element of grain `cell` that holds `point`; of several on a shared boundary the one whose
  /// centroid is nearest. A point that no element of the grain holds (it lies just outside the
  /// curved grain boundary) gets the element where the excess is least.
  Location find(const core::Vec3& point, int cell) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polyslip::remap
