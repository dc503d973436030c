#include "mesh/measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "mesh/face_fan.hpp"
#include "mesh/minimum.hpp"
#include "mesh/quality_criterion.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Faces and edges, translates beside their masters.
void add_entities(const Topology& t, Measures& m) {
  std::vector<int> master(t.edges.size());
  std::iota(master.begin(), master.end(), 0);
  for (const auto& pair : t.periodic.edges) {
    master[pair.slave] = pair.master;
    m.edges[pair.slave].is_translate = true;
  }
  for (const auto& pair : t.periodic.faces) m.faces[pair.slave].is_translate = true;
  for (std::size_t f = 0; f < t.faces.size(); ++f) {
    m.faces[f].cells = t.faces[f].cells;
    m.faces[f].domain_face = t.faces[f].domain_face;
    m.faces[f].edges = static_cast<int>(t.faces[f].edges.size());
    for (const int e : t.faces[f].edges)
      if (!m.faces[f].is_translate) ++m.edges[master[e]].faces;
  }
  for (const auto& pair : t.periodic.faces) {
    m.faces[pair.master].cells[1] = t.faces[pair.slave].cells[0];
    m.faces[pair.slave].cells[1] = t.faces[pair.master].cells[0];
  }
  for (std::size_t e = 0; e < t.edges.size(); ++e) {
    m.edges[e].vertices = t.edges[e].vertices;
    m.edges[e].faces = m.edges[master[e]].faces;
  }
}

/// A face or edge is inner if one of its translates is.
template <class Entity>
void share_inner(const std::vector<PeriodicPair>& pairs, std::vector<Entity>& all) {
  for (const auto& pair : pairs)
    if (all[pair.slave].inner) all[pair.master].inner = true;
  for (const auto& pair : pairs) all[pair.slave].inner = all[pair.master].inner;
}

/// What the topology says; sizes are left to the caller.
Measures topological(const Topology& t) {
  Measures m;
  m.grains.resize(t.cell_faces.size());
  m.faces.resize(t.faces.size());
  m.edges.resize(t.edges.size());
  m.vertices = t.vertex_count - static_cast<int>(t.periodic.vertices.size());
  add_entities(t, m);
  for (std::size_t c = 0; c < t.cell_faces.size(); ++c) {
    GrainMeasures& grain = m.grains[c];
    grain.inner = true;
    std::vector<int> others, vertices;
    int sides = 0;
    for (const int f : t.cell_faces[c]) {
      const FaceMeasures& face = m.faces[f];
      sides += face.edges;
      const auto loop = t.face_vertices(f);
      vertices.insert(vertices.end(), loop.begin(), loop.end());
      if (face.domain_face >= 0) grain.inner = false;
      const int other = face.cells[0] == static_cast<int>(c) ? face.cells[1] : face.cells[0];
      if (other >= 0 && other != static_cast<int>(c)) others.push_back(other);
    }
    std::sort(others.begin(), others.end());
    grain.neighbours = static_cast<int>(std::unique(others.begin(), others.end()) - others.begin());
    grain.faces = static_cast<int>(t.cell_faces[c].size());
    grain.edges = sides / 2;  // an edge of a cell is in two of its faces
    std::sort(vertices.begin(), vertices.end());
    grain.vertices =
        static_cast<int>(std::unique(vertices.begin(), vertices.end()) - vertices.begin());
    if (!grain.inner) continue;
    for (const int f : t.cell_faces[c]) {
      m.faces[f].inner = true;
      for (const int e : t.faces[f].edges) m.edges[e].inner = true;
    }
  }
  share_inner(t.periodic.faces, m.faces);
  share_inner(t.periodic.edges, m.edges);
  return m;
}

/// Areas of the grains' surfaces from those of the faces.
void add_surfaces(const Topology& t, Measures& m) {
  for (std::size_t c = 0; c < t.cell_faces.size(); ++c)
    for (const int f : t.cell_faces[c]) m.grains[c].area += m.faces[f].area;
}

/// Three-point Gauss rule on [0, 1], degree 5.
struct LineRule {
  std::array<double, 3> point{(1 - std::sqrt(0.6)) / 2, 0.5, (1 + std::sqrt(0.6)) / 2};
  std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
};

double line_length(const Mesh& mesh, const std::array<int, 3>& line) {
  const Vec3 &a = mesh.nodes[line[0]], &b = mesh.nodes[line[1]];
  if (mesh.order == 1) return (b - a).norm();
  const Vec3& mid = mesh.nodes[line[2]];
  const LineRule rule;
  double length = 0;
  for (int q = 0; q < 3; ++q) {
    const double s = rule.point[q];
    length += rule.weight[q] * ((4 * s - 3) * a + (4 * s - 1) * b + (4 - 8 * s) * mid).norm();
  }
  return length;
}

/// Seven points, degree 5 (Radon, 1948): barycentric coordinates and weights that add up to 1.
struct TriangleRule {
  std::array<std::array<double, 2>, 7> point;
  std::array<double, 7> weight;
  std::array<std::array<std::array<double, 2>, 6>, 7> gradients;
  TriangleRule() {
    const double root = std::sqrt(15.0);
    const double a = (6 - root) / 21, b = (6 + root) / 21;
    point = {{{1.0 / 3, 1.0 / 3},
              {a, a},
              {1 - 2 * a, a},
              {a, 1 - 2 * a},
              {b, b},
              {1 - 2 * b, b},
              {b, 1 - 2 * b}}};
    const double wa = (155 - root) / 1200, wb = (155 + root) / 1200;
    weight = {9.0 / 40, wa, wa, wa, wb, wb, wb};
    for (int q = 0; q < 7; ++q) gradients[q] = tri6_gradients(point[q][0], point[q][1]);
  }
};

double triangle_area(const Mesh& mesh, const std::array<int, 6>& t, const TriangleRule& rule) {
  const Vec3& origin = mesh.nodes[t[0]];
  if (mesh.order == 1)
    return 0.5 * (mesh.nodes[t[1]] - origin).cross(mesh.nodes[t[2]] - origin).norm();
  std::array<Vec3, 6> x;
  for (int i = 0; i < 6; ++i) x[i] = mesh.nodes[t[i]] - origin;
  double area = 0;
  for (int q = 0; q < 7; ++q) {
    Vec3 u = Vec3::Zero(), v = Vec3::Zero();
    for (int i = 0; i < 6; ++i) {
      u += rule.gradients[q][i][0] * x[i];
      v += rule.gradients[q][i][1] * x[i];
    }
    area += 0.5 * rule.weight[q] * u.cross(v).norm();
  }
  return area;
}

/// Least angle [degrees] at the vertices of a loop.
double least_corner(const std::vector<Vec3>& loop) {
  double least = 180;
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 u = loop[(i + 1) % n] - loop[i], v = loop[(i + n - 1) % n] - loop[i];
    const double angle = std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi;
    least = min_or_nan(least, angle);
  }
  return least;
}

/// Largest angle [degrees] between two of the unit normals; equal ones are compared once.
double largest_angle(std::vector<Vec3>& normals) {
  std::vector<Vec3> distinct;
  for (const Vec3& n : normals) {
    const bool seen = std::any_of(distinct.begin(), distinct.end(),
                                  [&](const Vec3& d) { return (d - n).squaredNorm() < 1e-20; });
    if (!seen) distinct.push_back(n);
  }
  double chord = 0;
  for (std::size_t i = 0; i < distinct.size(); ++i)
    for (std::size_t j = i + 1; j < distinct.size(); ++j)
      chord = std::max(chord, (distinct[i] - distinct[j]).squaredNorm());
  return degrees_of_chord(chord);
}

void add_faces(const Mesh& mesh, Measures& m) {
  const TriangleRule rule;
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < mesh.triangles.size();) {
    const int face = mesh.triangle_face[i];
    normals.clear();
    for (; i < mesh.triangles.size() && mesh.triangle_face[i] == face; ++i) {
      const auto& t = mesh.triangles[i];
      m.faces[face].area += triangle_area(mesh, t, rule);
      const Vec3& a = mesh.nodes[t[0]];
      normals.push_back((mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).normalized());
    }
    m.faces[face].flatness_fault = largest_angle(normals);
  }
}

void add_centroids(const Mesh& mesh, Measures& m) {
  std::vector<double> volumes(m.grains.size(), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& t = mesh.tetrahedra[e];
    const Vec3 &a = mesh.nodes[t[0]], &b = mesh.nodes[t[1]];
    const Vec3 &c = mesh.nodes[t[2]], &d = mesh.nodes[t[3]];
    const double volume = (b - a).cross(c - a).dot(d - a) / 6;
    volumes[mesh.tetrahedron_cell[e]] += volume;
    m.grains[mesh.tetrahedron_cell[e]].centroid += volume * (a + b + c + d) / 4;
  }
  for (std::size_t c = 0; c < m.grains.size(); ++c) m.grains[c].centroid /= volumes[c];
}

/// Centroid and volume of a cell from the tetrahedra between its triangles and a point near it.
void add_cell(const Tessellation& tessellation, int cell,
              const std::vector<std::vector<Vec3>>& loops, GrainMeasures& grain) {
  const auto& t = tessellation.topology;
  const Vec3& origin = tessellation.seeds[cell];
  Vec3 moment = Vec3::Zero();
  for (const int f : t.cell_faces[cell]) {
    const double sign = t.faces[f].cells[0] == cell ? 1 : -1;
    for_each_fan_triangle(loops[f], tessellation.face_masters[f],
                          [&](const Vec3& a, const Vec3& b, const Vec3& m) {
                            const Vec3 u = a - origin, v = b - origin, w = m - origin;
                            const double volume = sign * u.dot(v.cross(w)) / 6;
                            grain.volume += volume;
                            moment += volume * (u + v + w) / 4;
                          });
  }
  grain.centroid = origin + moment / grain.volume;
}

}  // namespace

double GrainMeasures::diameter() const { return std::cbrt(6 * volume / std::numbers::pi); }

double GrainMeasures::sphericity() const {
  return std::numbers::pi * diameter() * diameter() / area;
}

double FaceMeasures::diameter() const { return 2 * std::sqrt(area / std::numbers::pi); }

Measures measure(const Tessellation& tessellation) {
  const auto& t = tessellation.topology;
  Measures m = topological(t);
  std::vector<std::vector<Vec3>> loops(t.faces.size());
  for (std::size_t f = 0; f < t.faces.size(); ++f) {
    for (const int v : t.face_vertices(static_cast<int>(f)))
      loops[f].push_back(tessellation.vertices[v]);
    const int master = tessellation.face_masters[f];
    for_each_fan_triangle(loops[f], master, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      m.faces[f].area += 0.5 * (b - a).cross(c - a).norm();
    });
    m.faces[f].flatness_fault = degrees_of_chord(fan_fault(loops[f], master));
    m.faces[f].least_corner = least_corner(loops[f]);
  }
  for (std::size_t e = 0; e < t.edges.size(); ++e)
    m.edges[e].length = (tessellation.vertices[t.edges[e].vertices[1]] -
                         tessellation.vertices[t.edges[e].vertices[0]])
                            .norm();
  for (int c = 0; c < t.cell_count(); ++c) add_cell(tessellation, c, loops, m.grains[c]);
  add_surfaces(t, m);
  return m;
}

Measures measure(const Mesh& mesh) {
  Measures m = topological(mesh.topology);
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
    m.edges[mesh.line_edge[i]].length += line_length(mesh, mesh.lines[i]);
  add_faces(mesh, m);
  for (std::size_t f = 0; f < m.faces.size(); ++f) {
    std::vector<Vec3> loop;
    for (const int v : mesh.topology.face_vertices(static_cast<int>(f)))
      loop.push_back(mesh.nodes[mesh.vertex_nodes[v]]);
    m.faces[f].least_corner = least_corner(loop);
  }
  add_surfaces(mesh.topology, m);
  const auto volumes = grain_volumes(mesh);
  for (std::size_t c = 0; c < m.grains.size(); ++c) m.grains[c].volume = volumes[c];
  add_centroids(mesh, m);
  return m;
}

ElementMeasures measure_element(const Mesh& mesh, int element) {
  const auto& t = mesh.tetrahedra[element];
  const auto x = [&](int i) -> const Vec3& { return mesh.nodes[t[i]]; };
  ElementMeasures measures;
  measures.radius_ratio = radius_ratio(x(0), x(1), x(2), x(3));
  for (const auto& [i, j] : tetrahedron_edges) measures.size += (x(i) - x(j)).norm() / 6;
  return measures;
}

std::vector<GrainMeshMeasures> measure_grain_meshes(const Mesh& mesh, double element_size) {
  return measure_grain_meshes(mesh,
                              std::vector<double>(mesh.topology.cell_faces.size(), element_size));
}

std::vector<GrainMeshMeasures> measure_grain_meshes(const Mesh& mesh,
                                                    const std::vector<double>& element_sizes) {
  std::vector<GrainMeshMeasures> grains(mesh.topology.cell_faces.size());
  std::vector<QualityCriterion> criteria(element_sizes.begin(), element_sizes.end());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const ElementMeasures m = measure_element(mesh, e);
    GrainMeshMeasures& grain = grains[mesh.tetrahedron_cell[e]];
    grain.min_radius_ratio =
        grain.elements == 0 ? m.radius_ratio : min_or_nan(grain.min_radius_ratio, m.radius_ratio);
    ++grain.elements;
    grain.mean_radius_ratio += m.radius_ratio;
    grain.mean_size += m.size;
    criteria[mesh.tetrahedron_cell[e]].add(m.radius_ratio, m.size);
  }
  for (std::size_t c = 0; c < grains.size(); ++c) {
    if (grains[c].elements == 0) continue;
    grains[c].mean_radius_ratio /= grains[c].elements;
    grains[c].mean_size /= grains[c].elements;
    grains[c].O_dis = criteria[c].distortion();
    grains[c].O_size = criteria[c].size();
    grains[c].O = criteria[c].value();
  }
  return grains;
}

}  // namespace polyslip::mesh
