#include "mesh/star_mesh.hpp"

#include <algorithm>
#include <limits>

#include "mesh/mesh.hpp"
#include "mesh/minimum.hpp"
#include "mesh/node_relocation.hpp"
#include "mesh/tet_store.hpp"

namespace polyslip::mesh {

using core::Vec3;

StarMesh::StarMesh(std::vector<Vec3> nodes, std::vector<Tet> tets, int surface_count)
    : nodes_(std::move(nodes)), tets_(std::move(tets)), first_(surface_count + 1, 0) {
  for (const Tet& t : tets_)
    for (const int n : t)
      if (n < surface_count) ++first_[n + 1];
  for (int n = 0; n < surface_count; ++n) first_[n + 1] += first_[n];
  stars_.resize(first_.back());
  std::vector<std::int64_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < tets_.size(); ++t)
    for (const int n : tets_[t])
      if (n < surface_count) stars_[next[n]++] = static_cast<int>(t);
}

StarDescent star_descent(const StarMesh& mesh, int node, int power) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  StarDescent d{0, infinity, infinity, Vec3::Zero()};
  const Vec3& x = mesh.position(node);
  for (const int number : mesh.star(node)) {
    const auto& tet = mesh.tet(number);
    const int i = corner_of(tet, node), j = (i + 1) % 4;
    const Vec3& p = mesh.position(tet[j]);
    const Vec3& q = mesh.position(tet[even_permutations[i][j][0]]);
    const Vec3& r = mesh.position(tet[even_permutations[i][j][1]]);
    const double rho = radius_ratio(x, p, q, r);
    const double value = barrier(rho, power);
    d.sum += value;
    d.gradient -= power * value * log_radius_ratio_gradient(x, p, q, r);
    d.least = min_or_nan(d.least, rho);
    d.reach = std::min({d.reach, (x - p).norm(), (x - q).norm(), (x - r).norm()});
  }
  return d;
}

bool star_improves(const StarMesh& mesh, int node, const Vec3& x, const StarDescent& now,
                   int power) {
  double sum = 0;
  for (const int number : mesh.star(node)) {
    const auto& tet = mesh.tet(number);
    std::array<const Vec3*, 4> corners{};
    for (int i = 0; i < 4; ++i) corners[i] = tet[i] == node ? &x : &mesh.position(tet[i]);
    const double rho = radius_ratio(*corners[0], *corners[1], *corners[2], *corners[3]);
    if (!(rho >= now.least)) return false;
    sum += barrier(rho, power);
    if (!(sum < now.sum)) return false;
  }
  return true;
}

}  // namespace polyslip::mesh
