#include "mesh/node_insertion.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/minimum.hpp"
#include "mesh/node_relocation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using Tet = TetStore::Tet;

constexpr int largest_hole = 40;
constexpr int relocations = 10;
/// Of places above a facet, in lengths of its longest edge; 0.55 is best above needles.
constexpr std::array<double, 2> heights{0.55, 0.3};
/// A new node is relocated only if it starts above this share.
constexpr double start_share = 0.3;

/// Tetrahedra taken away around a tetrahedron, for a node at x.
class Hole {
 public:
  Hole(const TetStore& store, int t, const Vec3& x) : store_(store), x_(x) {
    take(t);
    keep_best();
    while (static_cast<int>(tets_.size()) < largest_hole && grow()) keep_best();
  }

  double best() const { return best_; }
  int count() const { return best_count_; }
  /// Tetrahedra of the best hole.
  std::vector<int> tets() const { return {tets_.begin(), tets_.begin() + best_count_}; }

  /// Facets of the best hole, each seen from inside so that (node, facet) is positive.
  std::vector<std::array<int, 3>> facets() const {
    std::vector<std::array<int, 3>> result;
    const auto end = tets_.begin() + best_count_;
    for (auto it = tets_.begin(); it != end; ++it)
      for (int i = 0; i < 4; ++i) {
        const int s = store_.neighbour(*it, i);
        if (s < 0 || std::find(tets_.begin(), end, s) == end) result.push_back(facet(*it, i));
      }
    return result;
  }

 private:
  struct Side {
    int tet, corner, neighbour;
    double quality;
  };

  /// Corners opposite to corner i, for which (x, facet) is positive for x on corner i's side.
  std::array<int, 3> facet(int t, int i) const {
    const Tet& tet = store_.tet(t);
    const int j = (i + 1) % 4;
    const auto& others = even_permutations[i][j];
    return {tet[j], tet[others[0]], tet[others[1]]};
  }

  void take(int t) {
    tets_.push_back(t);
    std::erase_if(sides_, [&](const Side& s) { return s.neighbour == t; });
    for (int i = 0; i < 4; ++i) {
      const int s = store_.neighbour(t, i);
      if (s >= 0 && std::find(tets_.begin(), tets_.end(), s) != tets_.end()) continue;
      const auto f = facet(t, i);
      sides_.push_back(
          {t, i, s,
           radius_ratio(x_, store_.position(f[0]), store_.position(f[1]), store_.position(f[2]))});
    }
  }

  /// Takes the tetrahedron behind the worst facet; false if that is on the surface.
  bool grow() {
    const Side* worst = nullptr;
    for (const Side& s : sides_)
      if (!worst || s.quality < worst->quality) worst = &s;
    if (!worst || worst->neighbour < 0) return false;
    take(worst->neighbour);
    return true;
  }

  void keep_best() {
    double least = std::numeric_limits<double>::infinity();
    for (const Side& s : sides_) least = min_or_nan(least, s.quality);
    if (!(least > best_)) return;
    best_ = least;
    best_count_ = static_cast<int>(tets_.size());
  }

  const TetStore& store_;
  Vec3 x_;
  std::vector<int> tets_;
  std::vector<Side> sides_;
  double best_ = -std::numeric_limits<double>::infinity();
  int best_count_ = 0;
};

/// Places for a new node: inside, on the facets and edges, and above the facets.
std::vector<Vec3> starts(const TetStore& store, const Tet& tet) {
  const auto at = [&](int i) { return store.position(tet[i]); };
  const Vec3 sum = at(0) + at(1) + at(2) + at(3);
  std::vector<Vec3> result{sum / 4};
  for (int i = 0; i < 4; ++i) result.push_back((sum - at(i)) / 3);
  for (const auto& [i, j] : tetrahedron_edges) result.push_back((at(i) + at(j)) / 2);
  for (int i = 0; i < 4; ++i) {
    const Vec3 a = at((i + 1) % 4), b = at((i + 2) % 4), c = at((i + 3) % 4);
    Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(at(i) - a) < 0) normal = -normal;
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    for (const double height : heights)
      result.push_back((sum - at(i)) / 3 + height * longest * normal);
  }
  return result;
}

/// Number of the tetrahedron with these corners.
int number_of(const TetStore& store, const Tet& tet) {
  for (const int t : store.star(tet[0]))
    if (corner_of(store.tet(t), tet[1]) >= 0 && corner_of(store.tet(t), tet[2]) >= 0 &&
        corner_of(store.tet(t), tet[3]) >= 0)
      return t;
  return -1;
}

/// Puts a node at x into its best hole and relocates it, if the least radius ratio is then above
/// `wanted`; whether it is.
bool try_node(TetStore& store, const Tet& tet, const Vec3& x, double wanted, int power) {
  const Hole hole(store, number_of(store, tet), x);
  if (!(hole.best() > start_share * wanted)) return false;
  std::vector<Tet> before;
  const auto facets = hole.facets();
  for (const int s : hole.tets()) before.push_back(store.tet(s));
  const int node = store.add_node(x);
  for (const int s : hole.tets()) store.remove(s);
  for (const auto& f : facets) store.add({node, f[0], f[1], f[2]});
  for (int i = 0; i < relocations && relocate(store, node, power); ++i) {
  }
  if (store.star_quality(node) > wanted) return true;
  const std::vector<int> star = store.star(node);
  for (const int s : star) store.remove(s);
  for (const Tet& s : before) store.add(s);
  return false;
}

}  // namespace

bool insert_node(TetStore& store, int t, double gain, int power) {
  const Tet tet = store.tet(t);
  const double wanted = std::max(0.0, store.quality(t)) + gain;
  for (const Vec3& x : starts(store, tet))
    if (try_node(store, tet, x, wanted, power)) return true;
  return false;
}

}  // namespace polyslip::mesh
