#include "mesh/boundary_sliding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/parallel.hpp"
#include "mesh/assembly.hpp"
#include "mesh/minimum.hpp"
#include "mesh/projection.hpp"
#include "mesh/size_field.hpp"
#include "mesh/star_mesh.hpp"
#include "mesh/tetrahedral_optimiser.hpp"
#include "mesh/translates.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

constexpr int rounds = 1;
constexpr int sweeps = 3;
constexpr int halvings = 5;
constexpr double longest_step = 0.3;  // share of the least distance to a neighbour

/// Parts (edges or faces) by colour: parts of a colour share none of the things that they touch.
/// Each part takes the first colour that is free, in the order of the parts.
std::vector<std::vector<int>> colours(const std::vector<std::vector<int>>& touched,
                                      std::size_t thing_count) {
  std::vector<std::vector<char>> used(thing_count);
  std::vector<std::vector<int>> sets;
  for (std::size_t part = 0; part < touched.size(); ++part) {
    std::size_t colour = 0;
    const auto taken = [&](int thing) {
      return colour < used[thing].size() && used[thing][colour];
    };
    while (std::any_of(touched[part].begin(), touched[part].end(), taken)) ++colour;
    for (const int thing : touched[part]) {
      if (used[thing].size() <= colour) used[thing].resize(colour + 1, false);
      used[thing][colour] = true;
    }
    if (colour == sets.size()) sets.emplace_back();
    sets[colour].push_back(static_cast<int>(part));
  }
  return sets;
}

class BoundarySlider {
 public:
  BoundarySlider(BoundaryMesher& boundary, const std::vector<VolumeMesh>& volumes,
                 double progression_factor, int threads)
      : boundary_(boundary),
        topology_(boundary.geometry().topology),
        numbers_(boundary.numbers()),
        threads_(threads),
        progression_(progression_factor),
        positions_(boundary.positions(numbers_)),
        stars_(star_mesh(volumes)),
        edges_(translates(topology_.periodic.edges, static_cast<int>(topology_.edges.size()))),
        faces_(translates(topology_.periodic.faces, static_cast<int>(topology_.faces.size()))) {
    for (const auto& e : boundary.edges()) arcs_.push_back(e.arcs);
    for (const auto& f : boundary.faces())
      places_.emplace_back(f.places.empty() ? f.places.end() : f.places.begin() + f.boundary_count,
                           f.places.end());
    find_vertex_edges();
    colour_edges();
    colour_faces();
  }

  void run() {
    for (int i = 0; i < sweeps; ++i) {
      for (const auto& set : edge_colours_)
        core::parallel_for(threads_, set.size(), [&](std::size_t k) { slide_edge(set[k]); });
      for (const auto& set : face_colours_)
        core::parallel_for(threads_, set.size(), [&](std::size_t k) { slide_face(set[k]); });
    }
    for (std::size_t e = 0; e < arcs_.size(); ++e)
      if (slides(static_cast<int>(e))) boundary_.place_edge(static_cast<int>(e), arcs_[e]);
    core::parallel_for(threads_, topology_.faces.size(), [&](std::size_t f) {
      const int face = static_cast<int>(f);
      if (boundary_.is_copied(face) || faces_[f].empty()) return;
      boundary_.place_face(face, places_[f], positions_, numbers_);
    });
    boundary_.renew_slaves();
  }

 private:
  StarMesh star_mesh(const std::vector<VolumeMesh>& volumes) const {
    std::vector<Vec3> nodes;
    std::vector<StarMesh::Tet> tets;
    std::size_t node_count = positions_.size(), tet_count = 0;
    for (const auto& v : volumes) node_count += v.nodes.size(), tet_count += v.tetrahedra.size();
    nodes.reserve(node_count);
    tets.reserve(tet_count);
    for (const auto& x : positions_) nodes.push_back(scaled(x));
    for (int grain = 0; grain < topology_.cell_count(); ++grain) {
      auto ids = grain_surface(topology_, boundary_, numbers_, positions_, grain, boundary_.scale())
                     .numbers;
      const auto& volume = volumes[grain];
      for (std::size_t i = ids.size(); i < volume.nodes.size(); ++i) {
        ids.push_back(static_cast<int>(nodes.size()));
        nodes.push_back(volume.nodes[i]);
      }
      for (const auto& t : volume.tetrahedra)
        tets.push_back({ids[t[0]], ids[t[1]], ids[t[2]], ids[t[3]]});
    }
    return {std::move(nodes), std::move(tets), static_cast<int>(positions_.size())};
  }

  /// Slaves follow their masters. An edge from a vertex to its own translate stays: its ends are
  /// neighbours.
  bool slides(int edge) const {
    return arcs_[edge].size() > 2 && !edges_[edge].empty() && end_of(edge, 0) != end_of(edge, 1);
  }
  int end_of(int edge, int i) const {
    return boundary_.master_of_vertex(topology_.edges[edge].vertices[i]);
  }

  Vec3 scaled(const Vec3& x) const { return x.cwiseProduct(boundary_.scale()); }

  /// Edges touch the grains and vertices around them: elements at a vertex are compared too.
  void colour_edges() {
    const int grains = topology_.cell_count();
    std::vector<std::vector<int>> around(topology_.edges.size()), touched(around.size());
    for (const auto& face : topology_.faces)
      for (const int e : face.edges)
        for (const int c : face.cells)
          if (c >= 0) around[e].push_back(c);
    for (std::size_t i = 0; i < touched.size(); ++i) {
      const int e = static_cast<int>(i);
      if (!slides(e)) continue;
      for (const auto& image : edges_[e])
        touched[e].insert(touched[e].end(), around[image.entity].begin(),
                          around[image.entity].end());
      for (int end = 0; end < 2; ++end) touched[e].push_back(grains + end_of(e, end));
      std::sort(touched[e].begin(), touched[e].end());
      touched[e].erase(std::unique(touched[e].begin(), touched[e].end()), touched[e].end());
    }
    edge_colours_ = colours(touched, static_cast<std::size_t>(grains) + topology_.vertex_count);
  }

  void colour_faces() {
    std::vector<std::vector<int>> touched(topology_.faces.size());
    for (std::size_t f = 0; f < touched.size(); ++f)
      if (!boundary_.is_copied(static_cast<int>(f)) && !boundary_.faces()[f].inner_nodes.empty())
        for (const auto& image : faces_[f])
          for (const int c : topology_.faces[image.entity].cells)
            if (c >= 0) touched[f].push_back(c);
    face_colours_ = colours(touched, topology_.cell_count());
  }

  /// A node of an edge or face, with its translates on the others.
  using Images = std::vector<Translate>;

  Images nodes_of(const Images& parts, const std::vector<int>& first, std::size_t k) const {
    Images nodes;
    for (const auto& [part, shift] : parts)
      nodes.push_back({first[part] + static_cast<int>(k), shift});
    return nodes;
  }

  /// (P.29) over the elements at all translates.
  StarDescent descent(const Images& nodes) const {
    StarDescent sum = star_descent(stars_, nodes[0].entity);
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const StarDescent d = star_descent(stars_, nodes[i].entity);
      sum.sum += d.sum;
      sum.gradient += d.gradient;
      sum.least = min_or_nan(sum.least, d.least);
      sum.reach = std::min(sum.reach, d.reach);
    }
    return sum;
  }

  void move(const Images& nodes, const Vec3& x) {
    for (const auto& [node, shift] : nodes) {
      positions_[node] = translated(x, shift, boundary_.geometry().size);
      stars_.move(node, scaled(positions_[node]));
    }
  }

  /// Moves the node and its translates to x (unscaled) if that lowers the sum and lets no element
  /// fall below the least.
  bool improve(const Images& nodes, const Vec3& x, const StarDescent& now) {
    const int node = nodes[0].entity;
    if (nodes.size() == 1 && !star_improves(stars_, node, scaled(x), now)) return false;
    const Vec3 from = positions_[node];
    move(nodes, x);
    if (nodes.size() == 1) return true;
    const StarDescent d = descent(nodes);
    const bool better = d.least >= now.least && d.sum < now.sum;
    if (!better) move(nodes, from);
    return better;
  }

  /// Down the gradient of (P.29) along `tangent` (of the gradient) by a step that is halved until
  /// `place`, the node's position (unscaled) that far along, improves its star; whether it does.
  template <class Place>
  bool slide(const Images& nodes, const StarDescent& d, double slope, const Place& place) {
    if (!(d.least > 0) || !(slope > 0) || !std::isfinite(slope)) return false;
    double count = 0;
    for (const auto& [node, shift] : nodes) count += static_cast<double>(stars_.star(node).size());
    double step = std::min(longest_step * d.reach, (d.sum - count) / slope);
    for (int i = 0; i <= halvings; ++i, step /= 2) {
      const std::optional<Vec3> x = place(step);
      if (x && improve(nodes, *x, d)) return true;
    }
    return false;
  }

  void slide_edge(int edge) {
    auto& arcs = arcs_[edge];
    if (!slides(edge)) return;
    const CurvedEdge curve(boundary_.geometry().edges[edge], boundary_.scale());
    for (std::size_t k = 1; k + 1 < arcs.size(); ++k) {
      const Images nodes = nodes_of(edges_[edge], numbers_.edge_first, k - 1);
      const StarDescent d = descent(nodes);
      const double half = 1e-3 * std::min(arcs[k] - arcs[k - 1], arcs[k + 1] - arcs[k]);
      const Vec3 tangent = scaled(curve.at(arcs[k] + half) - curve.at(arcs[k] - half)) / (2 * half);
      const double slope = d.gradient.dot(tangent), from = arcs[k];
      double to = from;
      slide(nodes, d, std::abs(slope), [&](double step) -> std::optional<Vec3> {
        to = slope > 0 ? from - step : from + step;
        arcs[k] = to;
        const double after = progression(arcs, k);
        arcs[k] = from;
        const double ends_after = end_progression(edge, k, to);
        if (!(after <= std::max(progression_, progression(arcs, k)) &&
              ends_after <= std::max(progression_, end_progression(edge, k, from))))
          return std::nullopt;
        return boundary_.edge_point(edge, curve, to);
      });
      const Vec3& now = positions_[nodes[0].entity];
      if ((now - boundary_.edge_point(edge, curve, from)).norm() > 0) arcs[k] = to;
    }
  }

  /// Largest ratio of adjacent elements among those that node k changes; infinite if out of order.
  static double progression(const std::vector<double>& arcs, std::size_t k) {
    double worst = 1;
    const std::size_t last = std::min(k + 2, arcs.size() - 1);
    for (std::size_t i = k < 2 ? 2 : k; i <= last; ++i) {
      const double a = arcs[i - 1] - arcs[i - 2], b = arcs[i] - arcs[i - 1];
      if (!(a > 0 && b > 0)) return std::numeric_limits<double>::infinity();
      worst = std::max({worst, a / b, b / a});
    }
    return worst;
  }

  /// Largest ratio of the lengths of the edge's end elements, with node k at `arc`, to those of
  /// other edges at its vertices.
  double end_progression(int edge, std::size_t k, double arc) const {
    const auto& arcs = arcs_[edge];
    double worst = 1;
    if (k == 1) worst = std::max(worst, progression_at(end_of(edge, 0), edge, arc));
    if (k + 2 == arcs.size())
      worst = std::max(worst, progression_at(end_of(edge, 1), edge, arcs.back() - arc));
    return worst;
  }

  double progression_at(int vertex, int edge, double length) const {
    double worst = 1;
    for (int i = vertex_first_[vertex]; i < vertex_first_[vertex + 1]; ++i) {
      const auto [there, end] = vertex_edges_[i];
      const auto& arcs = arcs_[there];
      if (there == edge || arcs.empty()) continue;
      const double other = end == 0 ? arcs[1] : arcs.back() - arcs[arcs.size() - 2];
      worst = std::max({worst, length / other, other / length});
    }
    return worst;
  }

  /// Of translates the masters stand for all.
  template <class Visit>
  void for_each_end(const Visit& visit) const {
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e)
      for (int end = 0; end < 2 && !edges_[e].empty(); ++end) visit(e, end);
  }

  void find_vertex_edges() {
    vertex_first_.assign(topology_.vertex_count + 1, 0);
    for_each_end([&](int e, int end) { ++vertex_first_[end_of(e, end) + 1]; });
    std::partial_sum(vertex_first_.begin(), vertex_first_.end(), vertex_first_.begin());
    vertex_edges_.resize(vertex_first_.back());
    auto next = vertex_first_;
    for_each_end([&](int e, int end) { vertex_edges_[next[end_of(e, end)]++] = {e, end}; });
  }

  void slide_face(int face) {
    const auto count = boundary_.faces()[face].inner_nodes.size();
    if (count == 0 || boundary_.is_copied(face) || faces_[face].empty()) return;
    const FaceProjection projection = boundary_.projection(face);
    for (std::size_t k = 0; k < count; ++k) {
      const Images nodes = nodes_of(faces_[face], numbers_.face_first, k);
      const StarDescent d = descent(nodes);
      Eigen::Vector2d& place = places_[face][k];
      const Eigen::Vector2d from = place;
      const auto way = projection.descent(from, d.gradient);
      const bool moved = slide(nodes, d, way.slope, [&](double step) {
        place = from + step * way.direction;
        return boundary_.face_point(face, projection, place);
      });
      if (!moved) place = from;
    }
  }

  BoundaryMesher& boundary_;
  const Topology& topology_;
  const BoundaryNumbers numbers_;
  const int threads_;
  const double progression_;
  std::vector<Vec3> positions_;                        ///< by number, unscaled
  StarMesh stars_;                                     ///< scaled
  std::vector<std::vector<Translate>> edges_, faces_;  ///< with their slaves; of slaves none
  std::vector<std::vector<double>> arcs_;
  std::vector<std::vector<Eigen::Vector2d>> places_;  ///< of inner nodes of faces in their planes
  std::vector<int> vertex_first_;  ///< ends of edges at vertex v: [first[v], first[v + 1]) of
  std::vector<std::array<int, 2>> vertex_edges_;  ///< edge, which end of it
  std::vector<std::vector<int>> edge_colours_, face_colours_;
};

}  // namespace

void slide_boundary(BoundaryMesher& boundary, std::vector<VolumeMesh>& volumes,
                    double progression_factor, int threads) {
  const auto& topology = boundary.geometry().topology;
  for (int round = 0; round < rounds; ++round) {
    BoundarySlider(boundary, volumes, progression_factor, threads).run();
    const auto numbers = boundary.numbers();
    const auto positions = boundary.positions(numbers);
    core::parallel_for(threads, volumes.size(), [&](std::size_t grain) {
      const auto surface = grain_surface(topology, boundary, numbers, positions,
                                         static_cast<int>(grain), boundary.scale());
      auto& volume = volumes[grain];
      std::copy(surface.mesh.nodes.begin(), surface.mesh.nodes.end(), volume.nodes.begin());
      volume = optimise_inside(surface.mesh, volume);
    });
  }
}

}  // namespace polyslip::mesh
