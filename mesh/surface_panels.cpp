#include "mesh/surface_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/error.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Facets of a positive tetrahedron, outward by the right-hand rule.
constexpr std::array<std::array<int, 3>, 4> outward_facets{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

/// Mid node of a tetrahedron between two of its corners.
int mid_between(const std::array<int, 10>& t, int i, int j) {
  for (int e = 0; e < 6; ++e) {
    const auto& ends = tetrahedron_edges[e];
    if ((ends[0] == i && ends[1] == j) || (ends[0] == j && ends[1] == i)) return t[4 + e];
  }
  throw core::InternalError("a tetrahedron has no edge between two of its corners");
}

struct Facet {
  std::array<int, 3> key;    ///< corners, sorted
  std::array<int, 6> nodes;  ///< outward
  int cell;
};

class PanelFinder {
 public:
  PanelFinder(Mesh& mesh, const std::vector<int>& names, const TranslatedNodes& translated)
      : mesh_(mesh), names_(names), translated_(translated) {}

  SurfacePanels run() {
    find_panels();
    put_on_domain();
    return std::move(found_);
  }

 private:
  template <class... Args>
  [[noreturn]] static void fail(fmt::format_string<Args...> text, Args&&... args) {
    throw core::InputError(fmt::format(text, std::forward<Args>(args)...));
  }

  std::string at(int node) const {
    const Vec3& x = mesh_.nodes[node];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
  }

  std::vector<Facet> sorted_facets() const {
    std::vector<Facet> facets;
    facets.reserve(4 * mesh_.tetrahedra.size());
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const auto& t = mesh_.tetrahedra[e];
      for (const auto& [i, j, k] : outward_facets) {
        Facet f{
            {t[i], t[j], t[k]},
            {t[i], t[j], t[k], mid_between(t, i, j), mid_between(t, j, k), mid_between(t, k, i)},
            mesh_.tetrahedron_cell[e]};
        std::sort(f.key.begin(), f.key.end());
        facets.push_back(f);
      }
    }
    std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
      return std::tie(a.key, a.cell) < std::tie(b.key, b.cell);
    });
    return facets;
  }

  void find_panels() {
    const auto facets = sorted_facets();
    std::vector<Facet> free;
    for (std::size_t i = 0; i < facets.size();) {
      std::size_t end = i;
      while (end < facets.size() && facets[end].key == facets[i].key) ++end;
      const Facet& f = facets[i];
      if (end - i > 2)
        fail("{} elements share a facet of grain {} at {}", end - i, names_[f.cell],
             at(f.nodes[0]));
      if (end - i == 1)
        free.push_back(f);
      else if (facets[i + 1].cell != f.cell)
        found_.panels.push_back({f.nodes, f.cell, facets[i + 1].cell});
      i = end;
    }
    add_free(free);
    std::stable_sort(found_.panels.begin(), found_.panels.end(),
                     [](const Panel& a, const Panel& b) {
                       return std::tie(a.cell, a.other) < std::tie(b.cell, b.other);
                     });
  }

  /// Facets with one tetrahedron: two that are translates are of a periodic face each, others lie
  /// on the domain.
  void add_free(const std::vector<Facet>& free) {
    std::map<std::array<NodePlace, 3>, std::vector<std::pair<const Facet*, Shift>>> groups;
    for (const Facet& f : free) {
      const auto [key, shift] = translated_.standard(f.key);
      groups[key].push_back({&f, shift});
    }
    const int domain_faces = mesh_.domain.face_count();
    std::map<std::pair<int, Shift>, int> beyond;  // neighbours: grain, and where it is from here
    for (const auto& [key, group] : groups) {
      if (group.size() != 2) {
        for (const auto& [f, shift] : group)
          found_.panels.push_back({f->nodes, f->cell, -1 - domain_face(*f)});
        continue;
      }
      for (int i = 0; i < 2; ++i) {
        const auto& [f, shift] = group[i];
        const auto& [twin, there] = group[1 - i];
        const auto id = beyond.try_emplace({twin->cell, there - shift}, std::ssize(beyond)).first;
        found_.panels.push_back(
            {f->nodes, f->cell, -1 - domain_faces - id->second, found_.twins, there - shift});
      }
      ++found_.twins;
    }
  }

  /// How far the nodes of a facet are from a face of the domain, at most.
  double distance(const Facet& f, const Plane& plane) const {
    double most = 0;
    for (const int n : f.nodes)
      if (n >= 0) most = std::max(most, std::abs(plane.normal.dot(mesh_.nodes[n]) - plane.offset));
    return most;
  }

  /// The face of the domain that a facet without a neighbour lies on; its nodes are noted to lie
  /// there.
  int domain_face(const Facet& f) {
    const auto& faces = mesh_.domain.faces;
    int best = 0;
    for (int d = 1; d < static_cast<int>(faces.size()); ++d)
      if (distance(f, faces[d].plane) < distance(f, faces[best].plane)) best = d;
    if (!(distance(f, faces[best].plane) <= 1e-6 * mesh_.size.minCoeff()))
      fail(
          "grain {} has a free facet at {} that lies on no side of the bounding box: the mesh has "
          "a "
          "hole or a crack, or its domain is neither a box along the axes nor another convex body",
          names_[f.cell], at(f.nodes[0]));
    for (const int n : f.nodes)
      if (n >= 0) on_domain_.push_back({n, best});
    return best;
  }

  void put_on_domain() {
    const DomainFaceLists lists(mesh_.nodes.size(), std::move(on_domain_));
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      if (lists[n].empty()) continue;
      std::vector<Plane> planes;
      for (const int d : lists[n]) planes.push_back(mesh_.domain.faces[d].plane);
      put_on_planes(planes, mesh_.nodes[n]);
      for (int k = 0; k < 3; ++k)
        if (!mesh_.domain.periodic[k])
          mesh_.nodes[n][k] = std::clamp(mesh_.nodes[n][k], 0.0, mesh_.size[k]);
    }
  }

  Mesh& mesh_;
  const std::vector<int>& names_;
  const TranslatedNodes& translated_;
  SurfacePanels found_;
  std::vector<std::array<int, 2>> on_domain_;  ///< nodes and the faces they lie on
};

}  // namespace

SurfacePanels find_panels(Mesh& mesh, const std::vector<int>& names,
                          const TranslatedNodes& translated) {
  return PanelFinder(mesh, names, translated).run();
}

}  // namespace polyslip::mesh
