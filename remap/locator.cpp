#include "remap/locator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <nanoflann.hpp>

#include "mesh/shape_functions.hpp"

namespace polyslip::remap {
namespace {

using core::Mat3;
using core::Vec3;

constexpr double inside_tolerance = 1e-10;  // of barycentric coordinates; far above rounding

std::array<Vec3, 10> element_nodes(const mesh::Mesh& mesh, int element) {
  std::array<Vec3, 10> x;
  for (int i = 0; i < 10; ++i) x[i] = mesh.nodes[mesh.tetrahedra[element][i]];
  return x;
}

double excess_of(const Vec3& xi) {
  const double lowest = std::min({xi[0], xi[1], xi[2], 1 - xi.sum()});
  return std::max(0.0, -lowest);
}

/// Element centroids of one grain, as nanoflann wants them.
struct Cloud {
  std::vector<Vec3> points;
  std::vector<int> elements;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud,
                                                 3, std::size_t>;

}  // namespace

Location locate_in_element(const mesh::Mesh& mesh, int element, const Vec3& point) {
  const auto x = element_nodes(mesh, element);
  Mat3 straight;
  straight << x[1] - x[0], x[2] - x[0], x[3] - x[0];
  Location found{element, straight.inverse() * (point - x[0]), 0};
  // A point far from the element cannot be in it, and Newton's method would wander there.
  const double size = straight.norm();
  constexpr int max_iterations = 30;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const auto shape = mesh::tet10_shape(found.xi);
    Vec3 residual = -point;
    for (int i = 0; i < 10; ++i) residual += shape[i] * x[i];
    if (residual.norm() <= 1e-13 * size) {
      found.excess = excess_of(found.xi);
      return found;
    }
    const Mat3 jacobian = mesh::tet10_jacobian(x, mesh::tet10_gradients(found.xi));
    Vec3 step = jacobian.inverse() * residual;
    if (!step.allFinite()) break;
    if (const double length = step.norm(); length > 1) step /= length;
    found.xi -= step;
    if (step.norm() <= 1e-14) {
      found.excess = excess_of(found.xi);
      return found;
    }
  }
  found.excess = std::numeric_limits<double>::infinity();
  return found;
}

struct ElementLocator::Impl {
  const mesh::Mesh& mesh;
  std::vector<Cloud> clouds;
  std::vector<std::unique_ptr<Tree>> trees;
};

ElementLocator::ElementLocator(const mesh::Mesh& mesh)
    : impl_(new Impl{mesh, std::vector<Cloud>(mesh.topology.cell_faces.size()), {}}) {
  const Vec3 centre = Vec3::Constant(0.25);
  const auto shape = mesh::tet10_shape(centre);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto x = element_nodes(mesh, e);
    Vec3 centroid = Vec3::Zero();
    for (int i = 0; i < 10; ++i) centroid += shape[i] * x[i];
    Cloud& cloud = impl_->clouds[mesh.tetrahedron_cell[e]];
    cloud.points.push_back(centroid);
    cloud.elements.push_back(e);
  }
  for (const Cloud& cloud : impl_->clouds)
    impl_->trees.push_back(
        std::make_unique<Tree>(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10)));
}

ElementLocator::~ElementLocator() = default;

Location ElementLocator::find(const Vec3& point, int cell) const {
  const Cloud& cloud = impl_->clouds[cell];
  Location best{-1, Vec3::Zero(), std::numeric_limits<double>::infinity()};
  // Most points lie in one of the nearest elements; a point outside all of them needs a wider look.
  std::size_t tried = 0;
  for (std::size_t wanted : {std::size_t{8}, std::size_t{64}, std::size_t{512}}) {
    wanted = std::min(wanted, cloud.points.size());
    std::vector<std::size_t> indices(wanted);
    std::vector<double> distances(wanted);
    const std::size_t n =
        impl_->trees[cell]->knnSearch(point.data(), wanted, indices.data(), distances.data());
    for (std::size_t i = tried; i < n; ++i) {
      const Location here = locate_in_element(impl_->mesh, cloud.elements[indices[i]], point);
      if (here.excess < best.excess) best = here;
      if (best.excess <= inside_tolerance) return best;
    }
    tried = n;
    if (tried == cloud.points.size()) break;
    // Just outside a curved boundary: the nearest elements bound it well enough.
    if (wanted == 64 && best.excess < 0.05) break;
  }
  if (best.element < 0 && !cloud.elements.empty()) {
    // No iteration converged: the element with the nearest centroid, at its centroid.
    std::size_t index = 0;
    double distance = 0;
    impl_->trees[cell]->knnSearch(point.data(), 1, &index, &distance);
    best = {cloud.elements[index], Vec3::Constant(0.25), std::numeric_limits<double>::infinity()};
  }
  return best;
}

}  // namespace polyslip::remap
