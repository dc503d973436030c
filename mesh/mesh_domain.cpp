#include "mesh/mesh_domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Facets of a positive tetrahedron, outward by the right-hand rule.
constexpr std::array<std::array<int, 3>, 4> outward_facets{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

struct Facet {
  std::array<int, 3> key, nodes;  ///< corners, sorted and outward
  int element;
};

/// Facets of one tetrahedron only, in the order of elements.
std::vector<Facet> free_facets(const Mesh& mesh) {
  std::vector<Facet> all, found;
  all.reserve(4 * mesh.tetrahedra.size());
  for (int e = 0; e < mesh.element_count(); ++e)
    for (const auto& corners : outward_facets) {
      Facet f{{}, {}, e};
      for (int i = 0; i < 3; ++i) f.key[i] = f.nodes[i] = mesh.tetrahedra[e][corners[i]];
      std::sort(f.key.begin(), f.key.end());
      all.push_back(f);
    }
  std::sort(all.begin(), all.end(), [](const Facet& a, const Facet& b) { return a.key < b.key; });
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && all[end].key == all[i].key) ++end;
    if (end - i == 1) found.push_back(all[i]);
    i = end;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Facet& a, const Facet& b) { return a.element < b.element; });
  return found;
}

class WallFinder {
 public:
  WallFinder(const Mesh& mesh, const std::map<std::array<int, 3>, std::string>& surfaces)
      : mesh_(mesh), surfaces_(surfaces) {
    low_ = high_ = mesh.nodes[0];
    for (const Vec3& x : mesh.nodes) {
      low_ = low_.cwiseMin(x);
      high_ = high_.cwiseMax(x);
    }
    near_ = 1e-6 * (high_ - low_).minCoeff();
  }

  std::optional<MeshWalls> find() {
    const auto facets = free_facets(mesh_);
    if (std::all_of(facets.begin(), facets.end(), [&](const Facet& f) { return on_box(f); }))
      return {};
    for (const Facet& f : facets) add(f);
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      const Vec3 normal = areas_[i].normalized();
      walls_.planes[i] = {normal, normal.dot(mesh_.nodes[points_[i]])};
    }
    for (const Plane& p : walls_.planes)
      for (const Vec3& x : mesh_.nodes)
        if (p.normal.dot(x) > p.offset + near_) return {};
    return walls_;
  }

 private:
  bool on_box(const Facet& f) const {
    for (int axis = 0; axis < 3; ++axis)
      for (const double plane : {low_[axis], high_[axis]})
        if (std::all_of(f.nodes.begin(), f.nodes.end(),
                        [&](int n) { return std::abs(mesh_.nodes[n][axis] - plane) <= near_; }))
          return true;
    return false;
  }

  std::string name_of(const Facet& f) const {
    const auto found = surfaces_.find(f.key);
    return found == surfaces_.end() ? "" : found->second;
  }

  bool lies_on(const Facet& f, const Plane& plane, const Vec3& normal) const {
    return normal.dot(plane.normal) > 0.99 &&
           std::all_of(f.nodes.begin(), f.nodes.end(), [&](int n) {
             return std::abs(plane.normal.dot(mesh_.nodes[n]) - plane.offset) <= near_;
           });
  }

  /// Facets of a plane add up to its vector area.
  void add(const Facet& f) {
    const Vec3 &a = mesh_.nodes[f.nodes[0]], &b = mesh_.nodes[f.nodes[1]],
               &c = mesh_.nodes[f.nodes[2]];
    const Vec3 area = (b - a).cross(c - a), normal = area.normalized();
    for (std::size_t i = 0; i < walls_.planes.size(); ++i) {
      if (!lies_on(f, walls_.planes[i], normal)) continue;
      areas_[i] += area;
      return;
    }
    std::string name = name_of(f);
    if (name.empty()) name = fmt::format("f{}", walls_.planes.size() + 1);
    walls_.planes.push_back({normal, normal.dot(a)});
    walls_.names.push_back(name);
    areas_.push_back(area);
    points_.push_back(f.nodes[0]);
  }

  const Mesh& mesh_;
  const std::map<std::array<int, 3>, std::string>& surfaces_;
  Vec3 low_, high_;
  double near_ = 0;
  MeshWalls walls_;
  std::vector<Vec3> areas_;
  std::vector<int> points_;  ///< a node of each plane
};

}  // namespace

std::optional<MeshWalls> find_walls(const Mesh& mesh,
                                    const std::map<std::array<int, 3>, std::string>& surfaces) {
  return WallFinder(mesh, surfaces).find();
}

}  // namespace polyslip::mesh
