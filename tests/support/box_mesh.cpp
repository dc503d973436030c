#include "support/box_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace polyslip::tests {
namespace {

using core::Vec3;
using mesh::Mesh;
using Lattice = std::array<int, 3>;  // two steps a cube

/// Outward facets of a positive tetrahedron: corners, then mid nodes.
constexpr std::array<std::array<int, 3>, 4> facets{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
/// (y, z) of the box's four edges along x, counter-clockwise about x.
constexpr std::array<std::array<int, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
constexpr std::array<int, 4> side_domain_face{4, 3, 5, 2};

struct Builder {
  Lattice cells;
  int slabs;
  Mesh mesh;

  int node(const Lattice& p) const {
    return (p[0] * (2 * cells[1] + 1) + p[1]) * (2 * cells[2] + 1) + p[2];
  }
  int plane_face(int k) const { return k; }
  int side_face(int slab, int j) const { return slabs + 1 + 4 * slab + j; }
  int plane_edge(int k, int j) const { return 4 * k + j % 4; }
  int long_edge(int slab, int j) const { return 4 * (slabs + 1) + 4 * slab + j % 4; }
  int vertex(int k, int j) const { return 4 * k + j % 4; }
  Lattice vertex_place(int k, int j) const {
    return {2 * cells[0] / slabs * k, 2 * cells[1] * corners[j % 4][0],
            2 * cells[2] * corners[j % 4][1]};
  }

  void make_nodes();
  void make_tetrahedra();
  void make_topology();
  void make_triangles();
  void make_lines();
  void add_chain(int edge, const Lattice& from, const Lattice& to);
  int face_of(const std::array<Lattice, 3>& p, int cell) const;
};

void Builder::make_nodes() {
  const Vec3 n(2.0 * cells[0], 2.0 * cells[1], 2.0 * cells[2]);
  for (int i = 0; i <= 2 * cells[0]; ++i)
    for (int j = 0; j <= 2 * cells[1]; ++j)
      for (int k = 0; k <= 2 * cells[2]; ++k)
        mesh.nodes.push_back(mesh.size.cwiseProduct(Vec3(i, j, k)).cwiseQuotient(n));
}

void Builder::make_tetrahedra() {
  std::array<int, 3> axes{0, 1, 2};
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      for (int k = 0; k < cells[2]; ++k) {
        std::sort(axes.begin(), axes.end());
        do {
          std::array<Lattice, 4> p;
          p[0] = {2 * i, 2 * j, 2 * k};
          for (int s = 0; s < 3; ++s) {
            p[s + 1] = p[s];
            p[s + 1][axes[s]] += 2;
          }
          const bool even = (axes[1] - axes[0] + 3) % 3 == 1;
          if (!even) std::swap(p[1], p[2]);
          std::array<int, 10> t{};
          for (int c = 0; c < 4; ++c) t[c] = node(p[c]);
          for (int e = 0; e < 6; ++e) {
            const auto [a, b] = mesh::tetrahedron_edges[e];
            t[4 + e] =
                node({(p[a][0] + p[b][0]) / 2, (p[a][1] + p[b][1]) / 2, (p[a][2] + p[b][2]) / 2});
          }
          mesh.tetrahedra.push_back(t);
          mesh.tetrahedron_cell.push_back(i / (cells[0] / slabs));
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
}

void Builder::make_topology() {
  mesh::Topology& topology = mesh.topology;
  topology.vertex_count = 4 * (slabs + 1);
  for (int k = 0; k <= slabs; ++k)
    for (int j = 0; j < 4; ++j) topology.edges.push_back({{vertex(k, j), vertex(k, j + 1)}});
  for (int s = 0; s < slabs; ++s)
    for (int j = 0; j < 4; ++j) topology.edges.push_back({{vertex(s, j), vertex(s + 1, j)}});
  topology.cell_faces.resize(slabs);
  for (int k = 0; k <= slabs; ++k) {
    mesh::TopologyFace face;
    for (int j = 0; j < 4; ++j) face.edges.push_back(plane_edge(k, k == 0 ? (6 - j) % 4 : j));
    face.forward.assign(4, k != 0);
    face.cells =
        k == 0 ? std::array<int, 2>{0, -1} : std::array<int, 2>{k - 1, k == slabs ? -1 : k};
    face.domain_face = k == 0 ? 0 : k == slabs ? 1 : -1;
    topology.faces.push_back(face);
  }
  for (int s = 0; s < slabs; ++s)
    for (int j = 0; j < 4; ++j) {
      mesh::TopologyFace face;
      face.edges = {plane_edge(s, j), long_edge(s, j + 1), plane_edge(s + 1, j), long_edge(s, j)};
      face.forward = {true, true, false, false};
      face.cells = {s, -1};
      face.domain_face = side_domain_face[j];
      topology.faces.push_back(face);
    }
  for (int s = 0; s < slabs; ++s)
    topology.cell_faces[s] = {plane_face(s),   plane_face(s + 1), side_face(s, 0),
                              side_face(s, 1), side_face(s, 2),   side_face(s, 3)};
}

/// The face that a facet of a tetrahedron of `cell` lies on, if the cell is the face's first.
int Builder::face_of(const std::array<Lattice, 3>& p, int cell) const {
  const auto on = [&p](int axis, int value) {
    return p[0][axis] == value && p[1][axis] == value && p[2][axis] == value;
  };
  const int slab = 2 * cells[0] / slabs;
  if (on(0, 0)) return plane_face(0);
  if (on(0, (cell + 1) * slab)) return plane_face(cell + 1);
  if (on(2, 0)) return side_face(cell, 0);
  if (on(1, 2 * cells[1])) return side_face(cell, 1);
  if (on(2, 2 * cells[2])) return side_face(cell, 2);
  if (on(1, 0)) return side_face(cell, 3);
  return -1;
}

void Builder::make_triangles() {
  const auto place = [this](int n) {
    const int nz = 2 * cells[2] + 1, ny = 2 * cells[1] + 1;
    return Lattice{n / (ny * nz), n / nz % ny, n % nz};
  };
  std::vector<std::vector<std::array<int, 6>>> of_face(mesh.topology.faces.size());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    for (const auto& facet : facets) {
      std::array<int, 6> triangle{};
      std::array<Lattice, 3> p;
      for (int c = 0; c < 3; ++c) {
        triangle[c] = mesh.tetrahedra[e][facet[c]];
        p[c] = place(triangle[c]);
      }
      const int face = face_of(p, mesh.tetrahedron_cell[e]);
      if (face < 0) continue;
      for (int s = 0; s < 3; ++s) {
        const Lattice &a = p[s], &b = p[(s + 1) % 3];
        triangle[3 + s] = node({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
      }
      of_face[face].push_back(triangle);
    }
  for (std::size_t f = 0; f < of_face.size(); ++f)
    for (const auto& triangle : of_face[f]) {
      mesh.triangles.push_back(triangle);
      mesh.triangle_face.push_back(static_cast<int>(f));
    }
}

void Builder::add_chain(int edge, const Lattice& from, const Lattice& to) {
  int length = 0;
  Lattice step{};
  for (int a = 0; a < 3; ++a) {
    length = std::max(length, std::abs(to[a] - from[a]));
    step[a] = (to[a] > from[a]) - (to[a] < from[a]);
  }
  const auto at = [&](int i) {
    return node({from[0] + i * step[0], from[1] + i * step[1], from[2] + i * step[2]});
  };
  for (int i = 0; i < length; i += 2) {
    mesh.lines.push_back({at(i), at(i + 2), at(i + 1)});
    mesh.line_edge.push_back(edge);
  }
}

void Builder::make_lines() {
  for (int k = 0; k <= slabs; ++k)
    for (int j = 0; j < 4; ++j) {
      add_chain(plane_edge(k, j), vertex_place(k, j), vertex_place(k, j + 1));
      mesh.vertex_nodes.push_back(node(vertex_place(k, j)));
    }
  for (int s = 0; s < slabs; ++s)
    for (int j = 0; j < 4; ++j)
      add_chain(long_edge(s, j), vertex_place(s, j), vertex_place(s + 1, j));
}

}  // namespace

Mesh box_mesh(const std::array<int, 3>& cells, const Vec3& size, int slabs) {
  if (cells[0] % slabs != 0) throw std::invalid_argument("box_mesh: cells along x, slabs");
  Builder builder{cells, slabs, {}};
  builder.mesh.size = size;
  builder.mesh.domain = mesh::box_domain(size);
  builder.make_nodes();
  builder.make_tetrahedra();
  builder.make_topology();
  builder.make_triangles();
  builder.make_lines();
  return std::move(builder.mesh);
}

void distort(Mesh& mesh, double amount) {
  Vec3 spacing = mesh.size;
  for (const Vec3& x : mesh.nodes)
    for (int a = 0; a < 3; ++a)
      if (x[a] > 0) spacing[a] = std::min(spacing[a], 2 * x[a]);
  std::vector<Vec3> moved = mesh.nodes;
  for (std::size_t n = 0; n < moved.size(); ++n) {
    const Vec3 s = mesh.nodes[n].cwiseQuotient(mesh.size);
    double bubble = 1;
    for (int a = 0; a < 3; ++a) bubble *= std::min(1.0, 16 * s[a] * (1 - s[a]));
    for (int a = 0; a < 3; ++a)
      moved[n][a] += amount * bubble * spacing[a] *
                     std::sin(7.3 * s[a] + 4.1 * s[(a + 1) % 3] + 2.7 * s[(a + 2) % 3]);
  }
  mesh.nodes = moved;
  for (const auto& t : mesh.tetrahedra)
    for (int e = 0; e < 6; ++e)
      mesh.nodes[t[4 + e]] = (mesh.nodes[t[mesh::tetrahedron_edges[e][0]]] +
                              mesh.nodes[t[mesh::tetrahedron_edges[e][1]]]) /
                             2;
}

}  // namespace polyslip::tests
