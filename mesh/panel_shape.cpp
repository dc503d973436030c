#include "mesh/panel_shape.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "mesh/flattening.hpp"
#include "mesh/projection.hpp"

namespace polyslip::mesh {

using core::Vec3;

FaceShape shape_of(const Mesh& mesh, const std::vector<Panel>& panels,
                   const std::vector<int>& which) {
  FaceShape shape;
  std::map<std::pair<int, int>, int> places;  // of a node, or of the middle between two
  const auto place = [&](int a, int b, const Vec3& x) {
    const auto [at, fresh] =
        places.try_emplace(std::minmax(a, b), static_cast<int>(shape.points.size()));
    if (fresh) shape.points.push_back(x);
    return at->second;
  };
  for (const int p : which) {
    const auto& n = panels[p].nodes;
    std::array<int, 6> t{};
    for (int i = 0; i < 3; ++i) {
      const int a = n[i], b = n[(i + 1) % 3], mid = n[3 + i];
      t[i] = place(a, a, mesh.nodes[a]);
      t[3 + i] =
          place(a, b, mid >= 0 ? mesh.nodes[mid] : Vec3((mesh.nodes[a] + mesh.nodes[b]) / 2));
    }
    shape.triangles.push_back(t);
  }
  return shape;
}

bool lies_flat(const FaceShape& shape) {
  constexpr double plane_share = 0.3, conformal_share = 0.2;
  const Vec3 scale = Vec3::Ones();
  return FaceProjection(shape, scale).projects(plane_share) ||
         FaceProjection(shape, scale, conformal_places(shape, scale)).projects(conformal_share);
}

}  // namespace polyslip::mesh
