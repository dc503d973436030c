// Numbers of elements and nodes of edges beyond their own grading: progression across vertices,
// elements alike at acute corners, and nodes under triangles that are flat over a 1D element.

#include <algorithm>
#include <limits>

#include "mesh/boundary_mesh.hpp"
#include "mesh/size_field.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// A triangle is flat over a 1D element if its height is below this share of the nearer end's
/// distance from the foot: the tangent of the greater of its acute angles.
constexpr double flat_height = 0.35;
/// Rounds in which the elements at vertices are made alike.
constexpr int balancing_rounds = 100;
/// Cosine of the angle (10 degrees) of corners of faces whose sides are to be alike.
constexpr double acute_cosine = 0.98481;
/// Sides of such a corner are alike if their lengths differ by no more than this share.
constexpr double alike = 0.02;
constexpr int corner_rounds = 5;

}  // namespace

std::vector<double> BoundaryMesher::graded_arcs(int edge, int least_count) const {
  return edge_nodes(edge_lengths_[edge], end_sizes_[edge][0], end_sizes_[edge][1],
                    sizes_.edges[edge], options_.progression_factor, least_count);
}

void BoundaryMesher::mesh_edges() {
  for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
    if (!edge_stale_[e] || is_slave_edge(e)) continue;
    edge_copied_[e] ? copy_edge(e) : mesh_edge(e);
  }
  balance_vertices();
  for (int i = 0; !geometry_.from_mesh && i < corner_rounds && balance_corners(); ++i)
    balance_vertices();
  copy_slave_edges();
}

std::array<double, 2> BoundaryMesher::end_elements(int edge) const {
  const auto& s = edges_[edge].arcs;
  return {s[1], s.back() - s[s.size() - 2]};
}

std::vector<double> BoundaryMesher::least_at_vertices() const {
  std::vector<double> least(geometry_.topology.vertex_count,
                            std::numeric_limits<double>::infinity());
  for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
    if (edge_copied_[e] || is_slave_edge(e)) continue;
    for (int i = 0; i < 2; ++i) {
      double& l = least[vertex_masters_[geometry_.topology.edges[e].vertices[i]]];
      l = std::min(l, end_elements(e)[i]);
    }
  }
  return least;
}

void BoundaryMesher::balance_vertices() {
  for (int i = 0; i < balancing_rounds && refine_at_vertices(); ++i) {
  }
}

bool BoundaryMesher::refine_at_vertices() {
  const auto least = least_at_vertices();
  const double p = options_.progression_factor;
  bool any = false;
  for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
    if (edge_copied_[e] || is_slave_edge(e)) continue;
    bool refine = false;
    for (int i = 0; i < 2; ++i) {
      const double most = p * least[vertex_masters_[geometry_.topology.edges[e].vertices[i]]];
      if (!(end_elements(e)[i] > most * (1 + 1e-9))) continue;
      end_sizes_[e][i] = std::min(end_sizes_[e][i], most);
      refine = true;
    }
    if (!refine) continue;
    cut_arcs_[e] = graded_arcs(e, static_cast<int>(edges_[e].arcs.size()));
    place_edge(e, cut_arcs_[e]);
    edge_stale_[e] = any = true;
  }
  return any;
}

bool BoundaryMesher::balance_corners() {
  bool any = false;
  for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
    if (face_copied_[f] || is_slave_face(f)) continue;
    const auto& face = geometry_.topology.faces[f];
    for (std::size_t i = 0; i < face.edges.size(); ++i) {
      const std::size_t j = (i + 1) % face.edges.size();
      any |= make_alike({edge_masters_[face.edges[i]], face.forward[i] ? 1 : 0},
                        {edge_masters_[face.edges[j]], face.forward[j] ? 0 : 1});
    }
  }
  return any;
}

/// The longer of two end elements, if the corner between them is acute, gets the other's length.
bool BoundaryMesher::make_alike(EdgeEnd a, EdgeEnd b) {
  if (a.edge == b.edge || edge_copied_[a.edge] || edge_copied_[b.edge]) return false;
  const Vec3 u = end_chord(a), v = end_chord(b);
  if (!(u.dot(v) > acute_cosine * u.norm() * v.norm())) return false;
  const double of_a = end_elements(a.edge)[a.end], of_b = end_elements(b.edge)[b.end];
  if (std::max(of_a, of_b) <= (1 + alike) * std::min(of_a, of_b)) return false;
  const auto [edge, end] = of_a > of_b ? a : b;
  const double length = std::min(of_a, of_b);
  const auto& arcs = edges_[edge].arcs;
  auto cut = with_node_at(arcs, end == 0 ? length : arcs.back() - length, grading(edge));
  if (cut.size() > arcs.size() + 1) return false;
  place_edge(edge, cut);
  cut_arcs_[edge] = std::move(cut);
  edge_stale_[edge] = true;
  return true;
}

/// From a vertex to the next node, in the scaled frame.
Vec3 BoundaryMesher::end_chord(EdgeEnd end) const {
  const auto& x = edges_[end.edge].nodes;
  const Vec3 chord = end.end == 0 ? x[1] - x[0] : x[x.size() - 2] - x.back();
  return chord.cwiseProduct(scale_);
}

double BoundaryMesher::largest_progression() const {
  const auto least = least_at_vertices();
  double worst = 1;
  for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
    if (edge_copied_[e] || is_slave_edge(e)) continue;
    worst = std::max(worst, mesh::largest_progression(edges_[e].arcs));
    for (int i = 0; i < 2; ++i)
      worst = std::max(worst, end_elements(e)[i] /
                                  least[vertex_masters_[geometry_.topology.edges[e].vertices[i]]]);
  }
  return worst;
}

std::vector<std::array<int, 2>> BoundaryMesher::loop_elements(int face) const {
  const auto& f = geometry_.topology.faces[face];
  std::vector<std::array<int, 2>> elements;
  for (std::size_t i = 0; i < f.edges.size(); ++i) {
    const int count = static_cast<int>(edges_[f.edges[i]].nodes.size()) - 1;
    for (int k = 0; k < count; ++k)
      elements.push_back({f.edges[i], f.forward[i] ? k : count - 1 - k});
  }
  return elements;
}

EdgeGrading BoundaryMesher::grading(int edge) const {
  return {end_sizes_[edge][0], end_sizes_[edge][1], sizes_.edges[edge],
          options_.progression_factor};
}

void BoundaryMesher::cut_edge(int edge, double arc) {
  cut_arcs_[edge] = with_node_at(edges_[edge].arcs, arc, grading(edge));
  edge_stale_[edge] = true;
}

/// The 1D element of a face and the arc length on its edge that lie under the apex of a triangle
/// that is flat over it: of the first such triangle whose edge is not stale; edge -1: there is
/// none.
BoundaryMesher::EdgePlace BoundaryMesher::under_flat_triangle(
    int face, const std::vector<Vec3>& x, const BoundaryNumbers& numbers) const {
  const auto loop = loop_elements(face);
  const auto nodes = face_nodes(face, numbers);
  const int n = static_cast<int>(loop.size());
  const auto at = [&](int local) -> Vec3 {
    if (local < n) return x[nodes[local]].cwiseProduct(scale_);
    return faces_[face].inner_nodes[local - n].cwiseProduct(scale_);
  };
  for (const auto& t : faces_[face].triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (a >= n || b != (a + 1) % n) continue;
      const auto [of_loop, element] = loop[a];
      const int edge = edge_masters_[of_loop];  // its elements are those of the translate
      if (edge_stale_[edge] || edge_copied_[edge]) continue;
      const Vec3 base = at(b) - at(a), side = at(t[(k + 2) % 3]) - at(a);
      const double foot = side.dot(base) / base.squaredNorm();
      const double height = side.cross(base).norm() / base.squaredNorm();
      if (!(height < flat_height * std::min(foot, 1 - foot))) continue;
      const auto& arcs = edges_[edge].arcs;
      const bool forward = nodes[a] == number_of(of_loop, element, numbers);
      const double share = forward ? foot : 1 - foot;
      return {edge, (1 - share) * arcs[element] + share * arcs[element + 1]};
    }
  return {};
}

bool BoundaryMesher::cut_under_flat_triangles(const std::vector<char>& faces) {
  const auto numbers_now = numbers();
  const auto x = positions(numbers_now);
  bool any = false;
  // One a face and round: two nodes that face each other must not both move to where the other was.
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const int f = static_cast<int>(i);
    if (!faces[i] || face_copied_[f] || is_slave_face(f)) continue;
    const auto place = under_flat_triangle(f, x, numbers_now);
    if (place.edge < 0) continue;
    cut_edge(place.edge, place.arc);
    any = true;
  }
  return any;
}

}  // namespace polyslip::mesh
