#include "mesh/deformed_regularisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "mesh/common_plane.hpp"
#include "mesh/curved_elements.hpp"
#include "mesh/star_mesh.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

constexpr int sweeps = 60;
constexpr int inner_sweeps = 4;  ///< in which nodes of surfaces stay
constexpr int halvings = 8;
constexpr double longest_step = 0.3;  ///< share of the mean edge length around a node
constexpr double shift = 0.02;        ///< of volumes near zero, share of the regular element's

/// h(V) = (V + sqrt(V^2 + 4 d^2))/2: positive for any V, and V where it is far above d (J. M.
/// Escobar et al., Comput. Methods Appl. Mech. Engrg. 192, 2003).
struct PositiveVolume {
  double value, slope;
};
PositiveVolume positive(double v, double d) {
  const double root = std::sqrt(v * v + 4 * d * d);
  // For V < 0 without cancellation.
  const double h = v >= 0 ? (v + root) / 2 : 2 * d * d / (root - v);
  return {h, h / root};
}

class Opener {
 public:
  Opener(Mesh& mesh, const Vec3& scale, const DeformedRegularisationOptions& options)
      : mesh_(mesh),
        scale_(scale),
        options_(options),
        stars_(scaled_nodes(), corners(), mesh.node_count()),
        start_(mesh.nodes),
        on_surface_(mesh.nodes.size(), false),
        fixed_(mesh.nodes.size(), false) {
    find_kinds();
    find_planes();
  }

  DeformedRegularisation run() {
    DeformedRegularisation result;
    result.elements_before = result.elements_after = static_cast<int>(bad_elements().size());
    for (int i = 0; i < sweeps; ++i) {
      const auto bad = bad_elements();
      result.elements_after = static_cast<int>(bad.size());
      if (bad.empty()) break;
      bool any = false;
      for (const int n : nodes_of(bad))
        if (i >= inner_sweeps || !on_surface_[n]) any |= relocate(n);
      if (!any && i >= inner_sweeps) break;
    }
    result.elements_after = static_cast<int>(bad_elements().size());
    put_back();
    for (int n = 0; n < mesh_.node_count(); ++n) {
      const double move = (mesh_.nodes[n] - start_[n]).cwiseProduct(scale_).norm();
      if (!is_corner_[n] || !on_surface_[n] || !(move > 0)) continue;
      ++result.moved;
      result.largest_move = std::max(result.largest_move, move);
    }
    return result;
  }

 private:
  std::vector<Vec3> scaled_nodes() const {
    std::vector<Vec3> nodes;
    for (const Vec3& x : mesh_.nodes) nodes.push_back(x.cwiseProduct(scale_));
    return nodes;
  }

  std::vector<StarMesh::Tet> corners() const {
    std::vector<StarMesh::Tet> tets;
    for (const auto& t : mesh_.tetrahedra) tets.push_back({t[0], t[1], t[2], t[3]});
    return tets;
  }

  void find_kinds() {
    is_corner_.assign(mesh_.nodes.size(), false);
    for (const auto& t : mesh_.tetrahedra)
      for (int i = 0; i < 4; ++i) is_corner_[t[i]] = true;
    for (const auto& t : mesh_.triangles)
      for (const int n : t) on_surface_[n] = true;
    for (const auto& p : mesh_.periodic_nodes)
      for (const int n : {p.slave, p.master}) fixed_[n] = true;
  }

  /// What holds the nodes of domain faces: the plane that the face is, or the axis that it faces;
  /// curved oblique ones hold them whole.
  void find_planes() {
    const std::size_t count = mesh_.domain.faces.size();
    std::vector<std::array<int, 2>> pairs;
    std::vector<Vec3> area(count, Vec3::Zero());
    std::vector<std::vector<Vec3>> points(count);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const int d = mesh_.topology.faces[mesh_.triangle_face[i]].domain_face;
      if (d < 0) continue;
      const auto& t = mesh_.triangles[i];
      const Vec3& a = mesh_.nodes[t[0]];
      area[d] += (mesh_.nodes[t[1]] - a).cross(mesh_.nodes[t[2]] - a) / 2;
      for (const int n : t) {
        pairs.push_back({n, d});
        points[d].push_back(mesh_.nodes[n]);
      }
    }
    node_faces_ = DomainFaceLists(mesh_.nodes.size(), pairs);
    for (std::size_t d = 0; d < count; ++d) {
      const Vec3& own = mesh_.domain.faces[d].plane.normal;
      const auto plane = common_plane(own, area[d], points[d], plane_rounding(mesh_.size));
      normals_.push_back(plane ? plane->normal : own);
      const bool along_axis = own.cwiseAbs().maxCoeff() == own.norm();
      if (!plane && !along_axis)
        for (const auto& [node, face] : pairs)
          if (face == static_cast<int>(d)) fixed_[node] = true;
    }
  }

  /// Of planes through the node's place at the start; their normals, scaled as positions are if
  /// asked.
  std::vector<Plane> planes_of(int node, bool scaled) const {
    std::vector<Plane> planes;
    for (const int d : node_faces_[node]) {
      const Vec3& n = normals_[d];
      if (scaled)
        planes.push_back({n.cwiseQuotient(scale_).normalized(), 0});
      else
        planes.push_back({n, n.dot(start_[node])});
    }
    return planes;
  }

  void keep_in_planes(int node, Vec3& x) const {
    if (fixed_[node])
      x = start_[node];
    else if (!node_faces_[node].empty())
      put_on_planes(planes_of(node, false), x);
  }

  /// The part of a gradient in the directions that the node has, scaled.
  Vec3 in_planes(int node, const Vec3& gradient) const {
    if (fixed_[node]) return Vec3::Zero();
    if (node_faces_[node].empty()) return gradient;
    const Directions free = free_directions(planes_of(node, true));
    Vec3 part = Vec3::Zero();
    for (int i = 0; i < free.count; ++i) part += free[i].dot(gradient) * free[i];
    return part;
  }

  double ratio(int t) const {
    const auto& e = stars_.tet(t);
    const auto x = [&](int i) -> const Vec3& { return stars_.position(e[i]); };
    const double rho = radius_ratio(x(0), x(1), x(2), x(3));
    return six_volumes(e) > 0 ? rho : -std::abs(rho);
  }

  double six_volumes(const StarMesh::Tet& e) const {
    const Vec3& a = stars_.position(e[0]);
    return (stars_.position(e[1]) - a)
        .cross(stars_.position(e[2]) - a)
        .dot(stars_.position(e[3]) - a);
  }

  std::vector<int> bad_elements() const {
    std::vector<int> list;
    for (int t = 0; t < mesh_.element_count(); ++t)
      if (!(ratio(t) >= options_.least_radius_ratio)) list.push_back(t);
    return list;
  }

  std::vector<int> nodes_of(const std::vector<int>& elements) const {
    std::vector<int> nodes;
    for (const int t : elements)
      for (const int n : stars_.tet(t)) nodes.push_back(n);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  struct Energy {
    double value = 0;
    Vec3 gradient = Vec3::Zero();
  };

  /// Sum over a node's star of the cube of the inverse mean ratio, eta = sum l^2 / (12 (3
  /// h)^(2/3)), 1 for regular elements.
  Energy energy(int node, double d) const {
    Energy sum;
    const Vec3& x = stars_.position(node);
    for (const int t : stars_.star(node)) {
      const auto& e = stars_.tet(t);
      double lengths = 0;
      Vec3 pull = Vec3::Zero();
      for (const auto& [i, j] : tetrahedron_edges)
        lengths += (stars_.position(e[i]) - stars_.position(e[j])).squaredNorm();
      for (const int n : e) pull += 2 * (x - stars_.position(n));
      const auto h = positive(six_volumes(e) / 6, d);
      const double eta = lengths / (12 * std::pow(3 * h.value, 2.0 / 3));
      // dV/dx: a third of the opposite facet's area, inwards.
      const Vec3 rise = volume_gradient(e, node);
      const Vec3 slope = eta * (pull / lengths - 2.0 / 3 * h.slope / h.value * rise);
      sum.value += eta * eta * eta;
      sum.gradient += 3 * eta * eta * slope;
    }
    return sum;
  }

  Vec3 volume_gradient(const StarMesh::Tet& e, int node) const {
    const auto at = [&](int i) -> const Vec3& { return stars_.position(e[i]); };
    const int k = static_cast<int>(std::find(e.begin(), e.end(), node) - e.begin());
    constexpr std::array<std::array<int, 3>, 4> opposite{
        {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};
    const auto& o = opposite[k];
    return (at(o[1]) - at(o[0])).cross(at(o[2]) - at(o[0])) / 6;
  }

  double mean_length(int node) const {
    double sum = 0;
    int count = 0;
    for (const int t : stars_.star(node))
      for (const int n : stars_.tet(t))
        if (n != node) sum += (stars_.position(n) - stars_.position(node)).norm(), ++count;
    return sum / count;
  }

  /// Down the energy's gradient, in the directions that the node has.
  bool relocate(int node) {
    const double length = mean_length(node);
    const double regular = length * length * length / (6 * std::sqrt(2.0));
    const Vec3 from = stars_.position(node);
    const Energy now = energy(node, shift * regular);
    const Vec3 g = in_planes(node, now.gradient);
    if (!(g.norm() > 0) || !std::isfinite(g.norm())) return false;
    double step = longest_step * length;
    const Vec3 origin = start_[node].cwiseProduct(scale_);
    for (int i = 0; i <= halvings; ++i, step /= 2) {
      const Vec3 to = from - step / g.norm() * g;
      if (on_surface_[node] && (to - origin).norm() > options_.largest_move) continue;
      stars_.move(node, to);
      if (energy(node, shift * regular).value < (1 - 1e-4) * now.value) return true;
    }
    stars_.move(node, from);
    return false;
  }

  /// Positions back into the mesh; mid nodes go half the way of both ends.
  void put_back() {
    std::vector<Vec3> moves(mesh_.nodes.size(), Vec3::Zero());
    for (int n = 0; n < mesh_.node_count(); ++n) {
      if (!is_corner_[n] || stars_.position(n) == start_[n].cwiseProduct(scale_)) continue;
      Vec3 x = stars_.position(n).cwiseQuotient(scale_);
      keep_in_planes(n, x);
      moves[n] = x - start_[n];
      mesh_.nodes[n] = x;
    }
    for (const auto& t : mesh_.tetrahedra)
      for (int k = 0; k < 6; ++k) {
        const auto& [i, j] = tetrahedron_edges[k];
        const Vec3 move = (moves[t[i]] + moves[t[j]]) / 2;
        if (move == Vec3::Zero()) continue;
        Vec3 x = start_[t[4 + k]] + move;
        keep_in_planes(t[4 + k], x);
        mesh_.nodes[t[4 + k]] = x;
      }
  }

  Mesh& mesh_;
  Vec3 scale_;
  DeformedRegularisationOptions options_;
  StarMesh stars_;  ///< scaled
  std::vector<Vec3> start_;
  std::vector<char> on_surface_, is_corner_;
  std::vector<char> fixed_;  ///< [nodes]
  DomainFaceLists node_faces_;
  std::vector<Vec3> normals_;  ///< [domain faces] across which their nodes stay
};

}  // namespace

DeformedRegularisation regularise_deformed(Mesh& mesh, const Vec3& scale,
                                           const DeformedRegularisationOptions& options) {
  const auto result = Opener(mesh, scale, options).run();
  if (result.elements_before == 0) return result;
  try {
    mend_curved_elements(mesh);
  } catch (const core::RecoverableError&) {
    // An element that cannot be mended: what counts is whether its surface can be meshed.
  }
  return result;
}

DeformedRegularisation open_thin_elements(Mesh& mesh, const Vec3& scale,
                                          DeformedRegularisationOptions options) {
  constexpr int doublings = 2;
  const Mesh start = mesh;
  DeformedRegularisation result = regularise_deformed(mesh, scale, options);
  for (int i = 0; i < doublings && result.elements_after > 0; ++i) {
    options.largest_move *= 2;
    mesh = start;
    result = regularise_deformed(mesh, scale, options);
  }
  return result;
}

}  // namespace polyslip::mesh
