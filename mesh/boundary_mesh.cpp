#include "mesh/boundary_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/error.hpp"
#include "mesh/common_plane.hpp"
#include "mesh/flattening.hpp"
#include "mesh/inner_edges.hpp"
#include "mesh/projection.hpp"
#include "mesh/size_field.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// Order of positions, for looking them up.
struct Before {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

/// Integral of the normal over a face, its triangles straight: zero of what has no area.
Vec3 area_vector(const FaceShape& shape) {
  Vec3 sum = Vec3::Zero();
  for (const auto& t : shape.triangles) {
    const Vec3& a = shape.points[t[0]];
    sum += (shape.points[t[1]] - a).cross(shape.points[t[2]] - a) / 2;
  }
  return sum;
}

}  // namespace

BoundaryMesher::BoundaryMesher(const Geometry& geometry, const MeshingOptions& options,
                               const Vec3& scale, FaceMeshers face_meshers)
    : geometry_(geometry),
      options_(options),
      scale_(scale),
      isotropy_(isotropic_scale(geometry)),
      vertices_(geometry.vertices),
      sizes_(element_sizes(geometry.topology, options)),
      edges_(geometry.edges.size()),
      faces_(geometry.faces.size()),
      cut_arcs_(geometry.edges.size()),
      edge_copied_(geometry.edges.size(), false),
      face_copied_(geometry.faces.size(), false),
      edge_stale_(geometry.edges.size(), true),
      face_stale_(geometry.faces.size(), true),
      why_copied_(geometry.faces.size()),
      forbidden_(geometry.faces.size()),
      face_meshers_(std::move(face_meshers)),
      face_mesher_(geometry.faces.size(), -1) {
  if (!face_meshers_) options_.face_meshers = {own_face_mesher};
  find_planes();
  for (const auto& shape : geometry.edges)
    edge_lengths_.push_back(CurvedEdge(shape, scale).length());
  join_translates();
  auto sizes =
      vertex_sizes(geometry.topology, edge_lengths_, sizes_.edges, options.progression_factor);
  for (int v = 0; v < geometry.topology.vertex_count; ++v)
    sizes[vertex_masters_[v]] = std::min(sizes[vertex_masters_[v]], sizes[v]);
  for (int v = 0; v < geometry.topology.vertex_count; ++v) sizes[v] = sizes[vertex_masters_[v]];
  for (const auto& edge : geometry.topology.edges)
    end_sizes_.push_back({sizes[edge.vertices[0]], sizes[edge.vertices[1]]});
}

/// The plane that all points of a domain face lie in, if they do: its own, moved along its normal,
/// or the one that the face's area has turned to (in simple shear).
std::optional<Plane> BoundaryMesher::common_plane(int domain_face) const {
  const Plane& own = geometry_.domain.faces[domain_face].plane;
  const double rounding = plane_rounding(geometry_.size);
  Vec3 area = Vec3::Zero();
  std::vector<Vec3> points;
  for (std::size_t f = 0; f < geometry_.faces.size(); ++f) {
    if (geometry_.topology.faces[f].domain_face != domain_face) continue;
    const auto& shape = geometry_.faces[f];
    area += area_vector(shape);
    points.insert(points.end(), shape.points.begin(), shape.points.end());
  }
  const auto common = mesh::common_plane(own.normal, area, points, rounding);
  if (!common) return std::nullopt;
  // Of the values that rounding gives: the plane of the undeformed domain if it is among them.
  const double margin = geometry_.from_mesh ? 0 : rounding;
  const bool kept = common->normal == own.normal && own.offset >= common->low - margin &&
                    own.offset <= common->high + margin;
  return Plane{common->normal, kept ? own.offset : common->low};
}

void BoundaryMesher::find_planes() {
  const auto& topology = geometry_.topology;
  for (std::size_t d = 0; d < geometry_.domain.faces.size(); ++d)
    planes_.push_back(common_plane(static_cast<int>(d)));
  vertex_planes_ = domain_faces_of_vertices(topology);
  edge_planes_ = domain_faces_of_edges(topology);
  for (int v = 0; v < topology.vertex_count; ++v) keep_in_planes(vertices_[v], vertex_planes_[v]);
}

void BoundaryMesher::keep_in_planes(Vec3& x, std::span<const int> domain_faces) const {
  if (domain_faces.empty()) return;
  std::vector<Plane> planes;
  for (const int d : domain_faces)
    if (planes_[d]) planes.push_back(*planes_[d]);
  put_on_planes(planes, x);
}

void BoundaryMesher::keep_in_plane_of(int face, Vec3& x) const {
  const int d = geometry_.topology.faces[face].domain_face;
  if (d >= 0 && planes_[d]) put_on_planes({&*planes_[d], 1}, x);
}

bool BoundaryMesher::copy(int face, const std::string& why) {
  if (!geometry_.from_mesh || face_copied_[face]) return false;
  face_copied_[face] = face_stale_[face] = true;
  why_copied_[face] = why;
  forbidden_[face].clear();
  for (int e : geometry_.topology.faces[face].edges)
    if (!edge_copied_[e]) edge_copied_[e] = edge_stale_[e] = true;
  return true;
}

void BoundaryMesher::mesh_edge(int edge) {
  if (!cut_arcs_[edge].empty()) return place_edge(edge, cut_arcs_[edge]);
  place_edge(edge, graded_arcs(edge, 1));
}

Vec3 BoundaryMesher::edge_point(int edge, const CurvedEdge& curve, double arc) const {
  Vec3 x = curve.at(arc);
  keep_in_planes(x, edge_planes_[edge]);
  return x;
}

void BoundaryMesher::place_edge(int edge, std::vector<double> arcs) {
  const CurvedEdge curve(geometry_.edges[edge], scale_);
  EdgeMesh& m = edges_[edge];
  m = {};
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    m.nodes.push_back(curve.at(arcs[i]));
    if (i > 0) m.mids.push_back(curve.at((arcs[i - 1] + arcs[i]) / 2));
  }
  m.arcs = std::move(arcs);
  finish_edge(edge);
}

/// Its nodes in their planes, its ends on the vertices.
void BoundaryMesher::finish_edge(int edge) {
  EdgeMesh& m = edges_[edge];
  for (auto& x : m.nodes) keep_in_planes(x, edge_planes_[edge]);
  for (auto& x : m.mids) keep_in_planes(x, edge_planes_[edge]);
  m.nodes.front() = vertices_[geometry_.topology.edges[edge].vertices[0]];
  m.nodes.back() = vertices_[geometry_.topology.edges[edge].vertices[1]];
}

void BoundaryMesher::copy_edge(int edge) {
  const auto& points = geometry_.edges[edge].points;
  EdgeMesh& m = edges_[edge];
  m = {};
  for (std::size_t i = 0; i < points.size(); ++i)
    (i % 2 == 0 ? m.nodes : m.mids).push_back(points[i]);
  finish_edge(edge);
}

BoundaryNumbers BoundaryMesher::numbers() const {
  BoundaryNumbers numbers;
  numbers.count = geometry_.topology.vertex_count;
  for (const auto& e : edges_) {
    numbers.edge_first.push_back(numbers.count);
    numbers.count += static_cast<int>(e.nodes.size()) - 2;
  }
  for (const auto& f : faces_) {
    numbers.face_first.push_back(numbers.count);
    numbers.count += static_cast<int>(f.inner_nodes.size());
  }
  return numbers;
}

std::vector<Vec3> BoundaryMesher::positions(const BoundaryNumbers& numbers) const {
  std::vector<Vec3> x = vertices_;
  x.reserve(numbers.count);
  for (const auto& e : edges_) x.insert(x.end(), e.nodes.begin() + 1, e.nodes.end() - 1);
  for (const auto& f : faces_) x.insert(x.end(), f.inner_nodes.begin(), f.inner_nodes.end());
  return x;
}

std::vector<int> BoundaryMesher::face_nodes(int face, const BoundaryNumbers& numbers) const {
  const auto& f = geometry_.topology.faces[face];
  std::vector<int> nodes;
  for (std::size_t i = 0; i < f.edges.size(); ++i) {
    const int e = f.edges[i], inner = static_cast<int>(edges_[e].nodes.size()) - 2;
    nodes.push_back(geometry_.topology.edges[e].vertices[f.forward[i] ? 0 : 1]);
    for (int k = 0; k < inner; ++k)
      nodes.push_back(numbers.edge_first[e] + (f.forward[i] ? k : inner - 1 - k));
  }
  for (std::size_t k = 0; k < faces_[face].inner_nodes.size(); ++k)
    nodes.push_back(numbers.face_first[face] + static_cast<int>(k));
  return nodes;
}

/// Length of the longest 1D element at each node of an edge (section 2.2.1.2), scaled frame.
std::vector<double> BoundaryMesher::node_sizes(const BoundaryNumbers& numbers) const {
  std::vector<double> sizes(numbers.count, 0.0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto& nodes = edges_[e].nodes;
    const int last = static_cast<int>(nodes.size()) - 1;
    const auto number = [&](int i) { return number_of(static_cast<int>(e), i, numbers); };
    for (int i = 0; i < last; ++i) {
      const double length = (nodes[i + 1] - nodes[i]).cwiseProduct(scale_).norm();
      for (int n : {number(i), number(i + 1)}) sizes[n] = std::max(sizes[n], length);
    }
  }
  for (const auto& pair : geometry_.topology.periodic.vertices)
    sizes[pair.master] = std::max(sizes[pair.master], sizes[pair.slave]);
  for (const auto& pair : geometry_.topology.periodic.vertices)
    sizes[pair.slave] = sizes[pair.master];
  return sizes;
}

std::string BoundaryMesher::name(int face) const {
  const auto& cells = geometry_.topology.faces[face].cells;
  return fmt::format("face {} between grains {} and {} (0: outside)", face + 1, cells[0] + 1,
                     cells[1] + 1);
}

FaceProjection BoundaryMesher::projection(int face, Flattening flattening) const {
  const auto& shape = geometry_.faces[face];
  switch (flattening) {
    case Flattening::mean_plane:
      return {shape, scale_};
    case Flattening::isotropic_plane:
      return {shape, scale_, isotropy_};
    case Flattening::conformal:
      return {shape, scale_, conformal_places(shape, scale_)};
    case Flattening::circle:
      return {shape, scale_, circle_places(shape, scale_)};
  }
  throw core::InternalError("a face laid flat in no known way");
}

double BoundaryMesher::place_mids(int face, const FaceProjection& projection,
                                  const std::vector<Vec3>& x) {
  double farthest = 0;
  auto& m = faces_[face];
  for (auto& e : m.inner_edges) {
    const Vec3 middle = (x[e.a] + x[e.b]) / 2;
    double beyond = 0;
    Eigen::Vector2d place = (m.places[e.a] + m.places[e.b]) / 2;
    e.mid = projection.nearest(middle, place, &beyond);
    keep_in_plane_of(face, e.mid);
    m.nearest_points += beyond > 0;
    farthest = std::max(farthest, beyond);
  }
  return farthest;
}

std::optional<Vec3> BoundaryMesher::face_point(int face, const FaceProjection& projection,
                                               const Eigen::Vector2d& place) const {
  double beyond = 0;
  Vec3 x = projection.lift(place, &beyond);
  if (!(beyond <= 0)) return std::nullopt;
  keep_in_plane_of(face, x);
  return x;
}

void BoundaryMesher::place_face(int face, const std::vector<Eigen::Vector2d>& inner_places,
                                const std::vector<Vec3>& positions,
                                const BoundaryNumbers& numbers) {
  const FaceProjection projection = this->projection(face);
  FaceMesh& m = faces_[face];
  std::vector<Vec3> x;
  for (const int n : face_nodes(face, numbers)) x.push_back(positions[n]);
  for (int i = 0; i < m.boundary_count; ++i) m.places[i] = projection.project(x[i]);
  std::copy(inner_places.begin(), inner_places.end(), m.places.begin() + m.boundary_count);
  std::copy(x.begin() + m.boundary_count, x.end(), m.inner_nodes.begin());
  m.nearest_points = 0;
  place_mids(face, projection, x);
}

void BoundaryMesher::copy_face_mesh(int face) {
  const auto& shape = geometry_.faces[face];
  const auto& f = geometry_.topology.faces[face];
  FaceMesh& result = faces_[face];
  result = {};
  std::map<Vec3, int, Before> local;  // by position: shapes do not share point numbers
  for (std::size_t i = 0; i < f.edges.size(); ++i) {
    const auto& points = geometry_.edges[f.edges[i]].points;
    const int last = static_cast<int>(points.size()) - 1;
    for (int k = 0; k < last; k += 2)
      local[points[f.forward[i] ? k : last - k]] = result.boundary_count++;
  }
  int count = result.boundary_count;
  for (const auto& t : shape.triangles) {
    std::array<int, 3> triangle{};
    for (int i = 0; i < 3; ++i) {
      const auto [it, added] = local.try_emplace(shape.points[t[i]], count);
      if (added) {
        result.inner_nodes.push_back(shape.points[t[i]]);
        ++count;
      }
      triangle[i] = it->second;
    }
    result.triangles.push_back(triangle);
  }
  for (const auto& [a, b, t, i] : inner_edges(result.triangles))
    result.inner_edges.push_back({a, b, shape.points[shape.triangles[t][3 + i]]});
  for (auto& x : result.inner_nodes) keep_in_plane_of(face, x);
  for (auto& e : result.inner_edges) keep_in_plane_of(face, e.mid);
}

/// Edges and faces that are stale, until none is: copying a face makes its neighbours stale.
void BoundaryMesher::mesh_faces(std::vector<char>& changed) {
  const auto& faces = geometry_.topology.faces;
  bool again = true;
  while (again) {
    again = false;
    mesh_edges();
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (std::any_of(faces[f].edges.begin(), faces[f].edges.end(),
                      [&](int e) { return edge_stale_[e]; })) {
        face_stale_[f] = true;
        forbidden_[f].clear();
      }
    std::fill(edge_stale_.begin(), edge_stale_.end(), false);
    std::vector<int> stale;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (face_stale_[f] && !is_slave_face(static_cast<int>(f)))
        stale.push_back(static_cast<int>(f));
    const auto faults = mesh_list(stale, nodes());
    for (const int f : stale) {
      face_stale_[f] = false;
      changed[f] = true;
    }
    for (std::size_t i = 0; i < stale.size(); ++i) {
      if (faults[i].empty()) continue;
      if (!copy(stale[i], faults[i]))
        throw core::RecoverableError(
            fmt::format("{} cannot be meshed: {}", name(stale[i]), faults[i]));
      again = true;
    }
    copy_slave_faces(changed);
  }
}

bool BoundaryMesher::forbid_shared_edges() {
  struct Use {
    std::array<int, 2> nodes;
    int rank;  ///< who may keep it: 0 a 1D element, 1 a copied face, 2 another face
    int face;
    std::array<int, 2> local;
    auto operator<=>(const Use&) const = default;
  };
  const auto numbers_now = numbers();
  std::vector<Use> uses;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const int f = static_cast<int>(i);
    const auto nodes = face_nodes(f, numbers_now);
    const int n = faces_[f].boundary_count;
    const auto add = [&](int a, int b, int rank) {
      const auto [low, high] = std::minmax(nodes[a], nodes[b]);
      uses.push_back({{low, high}, rank, rank == 0 ? -1 : f, {a, b}});
    };
    for (int k = 0; k < n; ++k) add(k, (k + 1) % n, 0);
    for (const auto& e : faces_[f].inner_edges)
      if (e.a < n && e.b < n) add(e.a, e.b, face_copied_[f] ? 1 : 2);
  }
  std::sort(uses.begin(), uses.end());
  bool any = false;
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].nodes != uses[i - 1].nodes || uses[i].rank != 2) continue;
    any |= forbid(uses[i].face, uses[i].local);
  }
  return any;
}

std::vector<std::span<const int>> BoundaryMesher::domain_faces_of_nodes(
    const BoundaryNumbers& numbers) const {
  std::vector<std::span<const int>> lists;
  for (int v = 0; v < geometry_.topology.vertex_count; ++v) lists.push_back(vertex_planes_[v]);
  for (std::size_t e = 0; e < edges_.size(); ++e)
    lists.insert(lists.end(), edges_[e].nodes.size() - 2, edge_planes_[e]);
  lists.resize(numbers.count);
  return lists;
}

bool BoundaryMesher::forbid_edges_in_planes() {
  const auto numbers_now = numbers();
  const auto domain_faces = domain_faces_of_nodes(numbers_now);
  bool any = false;
  for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
    if (face_copied_[f]) continue;
    const auto nodes = face_nodes(f, numbers_now);
    const int n = faces_[f].boundary_count;
    for (const auto& e : faces_[f].inner_edges) {
      if (e.a >= n || e.b >= n) continue;
      const auto &at_a = domain_faces[nodes[e.a]], &at_b = domain_faces[nodes[e.b]];
      const bool in_plane = std::any_of(at_a.begin(), at_a.end(), [&](int d) {
        return planes_[d] && d != geometry_.topology.faces[f].domain_face &&
               std::find(at_b.begin(), at_b.end(), d) != at_b.end();
      });
      if (in_plane) any |= forbid(f, {e.a, e.b});
    }
  }
  return any;
}

int BoundaryMesher::number_of(int edge, int node, const BoundaryNumbers& numbers) const {
  const int last = static_cast<int>(edges_[edge].nodes.size()) - 1;
  if (node == 0 || node == last) return geometry_.topology.edges[edge].vertices[node == 0 ? 0 : 1];
  return numbers.edge_first[edge] + node - 1;
}

std::vector<int> BoundaryMesher::update() {
  std::vector<char> changed(faces_.size(), false);
  constexpr int rounds = 16;  // each forbids more pairs of nodes, or copies a face
  constexpr int cuts = 10;
  mesh_faces(changed);
  auto meshed = changed;
  for (int i = 0; i < cuts && cut_under_flat_triangles(meshed); ++i) {
    std::fill(meshed.begin(), meshed.end(), false);
    mesh_faces(meshed);
    for (std::size_t f = 0; f < changed.size(); ++f) changed[f] |= meshed[f];
  }
  // Either may find some that the other does not.
  const auto forbid_edges = [this] {
    return int(forbid_shared_edges()) + forbid_edges_in_planes();
  };
  for (int i = 0; forbid_edges() > 0; ++i) {
    if (i == rounds) {
      const auto stale = std::find(face_stale_.begin(), face_stale_.end(), true);
      throw core::RecoverableError(
          fmt::format("{} has inner edges of other faces or in the domain's after {} meshes",
                      name(static_cast<int>(stale - face_stale_.begin())), rounds + 1));
    }
    mesh_faces(changed);
  }
  std::vector<int> list;
  for (std::size_t f = 0; f < changed.size(); ++f)
    if (changed[f]) list.push_back(static_cast<int>(f));
  return list;
}

double BoundaryMesher::distortion(int face) const {
  return projection(face, Flattening::isotropic_plane).distortion();
}

}  // namespace polyslip::mesh
