#include "mesh/boundary_slider.hpp"

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
#include "mesh/translates.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

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
                 const Sliding& sliding)
      : chosen_(sliding.chosen),
        power_(sliding.power),
        boundary_(boundary),
        topology_(boundary.geometry().topology),
        numbers_(boundary.numbers()),
        threads_(sliding.threads),
        progression_(sliding.progression_factor),
        positions_(boundary.positions(numbers_)),
        edges_(translates(topology_.periodic.edges, static_cast<int>(topology_.edges.size()))),
        faces_(translates(topology_.periodic.faces, static_cast<int>(topology_.faces.size()))),
        sliding_edges_(parts_with_chosen(edges_, numbers_.edge_first, numbers_.face_first.front())),
        sliding_faces_(parts_with_chosen(faces_, numbers_.face_first, numbers_.count)),
        grains_(grains_around_sliding()),
        stars_(star_mesh(volumes)) {
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
      if (boundary_.is_copied(face) || faces_[f].empty() || !has_moved(face)) return;
      boundary_.place_face(face, places_[f], positions_, numbers_);
    });
    boundary_.renew_slaves();
  }

  /// [grains] Whether nodes of a grain may have moved.
  const std::vector<char>& grains() const { return grains_; }

 private:
  /// Whether some node of each part (edge or face), or of a translate of it, slides. Part i has the
  /// numbers from first[i] to those of the next.
  std::vector<char> parts_with_chosen(const std::vector<std::vector<Translate>>& parts,
                                      const std::vector<int>& first, int end) const {
    std::vector<char> result(parts.size(), chosen_.empty());
    if (chosen_.empty()) return result;
    const auto has_chosen = [&](int part) {
      const int last = part + 1 < static_cast<int>(first.size()) ? first[part + 1] : end;
      return std::any_of(chosen_.begin() + first[part], chosen_.begin() + last,
                         [](char c) { return c != 0; });
    };
    for (std::size_t i = 0; i < parts.size(); ++i)
      result[i] = std::any_of(parts[i].begin(), parts[i].end(),
                              [&](const Translate& image) { return has_chosen(image.entity); });
    return result;
  }

  std::vector<char> grains_around_sliding() const {
    std::vector<char> result(topology_.cell_count(), chosen_.empty());
    if (chosen_.empty()) return result;
    std::vector<char> edges(edges_.size(), false), faces(faces_.size(), false);
    const auto mark_images = [](const std::vector<std::vector<Translate>>& parts,
                                const std::vector<char>& sliding, std::vector<char>& marks) {
      for (std::size_t i = 0; i < parts.size(); ++i)
        for (const auto& image : parts[i])
          if (sliding[i]) marks[image.entity] = true;
    };
    mark_images(edges_, sliding_edges_, edges);
    mark_images(faces_, sliding_faces_, faces);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const auto& face = topology_.faces[f];
      const bool moves = faces[f] || std::any_of(face.edges.begin(), face.edges.end(),
                                                 [&](int e) { return edges[e] != 0; });
      for (const int c : face.cells)
        if (moves && c >= 0) result[c] = true;
    }
    return result;
  }

  /// Whether nodes of a face or of its edges may have.
  bool has_moved(int face) const {
    const auto& edges = topology_.faces[face].edges;
    return sliding_faces_[face] ||
           std::any_of(edges.begin(), edges.end(), [&](int e) { return sliding_edges_[e] != 0; });
  }

  StarMesh star_mesh(const std::vector<VolumeMesh>& volumes) const {
    std::vector<Vec3> nodes;
    std::vector<StarMesh::Tet> tets;
    std::size_t node_count = positions_.size(), tet_count = 0;
    for (const auto& v : volumes) node_count += v.nodes.size(), tet_count += v.tetrahedra.size();
    nodes.reserve(node_count);
    tets.reserve(tet_count);
    for (const auto& x : positions_) nodes.push_back(scaled(x));
    for (int grain = 0; grain < topology_.cell_count(); ++grain) {
      if (!grains_[grain]) continue;
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
    return sliding_edges_[edge] && arcs_[edge].size() > 2 && !edges_[edge].empty() &&
           end_of(edge, 0) != end_of(edge, 1);
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
      if (sliding_faces_[f] && !boundary_.is_copied(static_cast<int>(f)) &&
          !boundary_.faces()[f].inner_nodes.empty())
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

  bool is_chosen(const Images& nodes) const {
    return chosen_.empty() || std::any_of(nodes.begin(), nodes.end(), [&](const Translate& image) {
             return chosen_[image.entity] != 0;
           });
  }

  /// (P.29) over the elements at all translates.
  StarDescent descent(const Images& nodes) const {
    StarDescent sum = star_descent(stars_, nodes[0].entity, power_);
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const StarDescent d = star_descent(stars_, nodes[i].entity, power_);
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
    if (nodes.size() == 1 && !star_improves(stars_, node, scaled(x), now, power_)) return false;
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
      if (!is_chosen(nodes)) continue;
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
      if (!is_chosen(nodes)) continue;
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

  const std::vector<char>& chosen_;
  const int power_;  ///< of 1/rho in the sums
  BoundaryMesher& boundary_;
  const Topology& topology_;
  const BoundaryNumbers numbers_;
  const int threads_;
  const double progression_;
  std::vector<Vec3> positions_;                        ///< by number, unscaled
  std::vector<std::vector<Translate>> edges_, faces_;  ///< with their slaves; of slaves none
  const std::vector<char> sliding_edges_, sliding_faces_;
  const std::vector<char> grains_;  ///< around nodes that slide
  StarMesh stars_;                  ///< scaled, of these grains
  std::vector<std::vector<double>> arcs_;
  std::vector<std::vector<Eigen::Vector2d>> places_;  ///< of inner nodes of faces in their planes
  std::vector<int> vertex_first_;  ///< ends of edges at vertex v: [first[v], first[v + 1]) of
  std::vector<std::array<int, 2>> vertex_edges_;  ///< edge, which end of it
  std::vector<std::vector<int>> edge_colours_, face_colours_;
};

}  // namespace

std::vector<char> slide_nodes(BoundaryMesher& boundary, const std::vector<VolumeMesh>& volumes,
                              const Sliding& sliding) {
  BoundarySlider slider(boundary, volumes, sliding);
  slider.run();
  return slider.grains();
}

}  // namespace polyslip::mesh
