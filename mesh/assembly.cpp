#include "mesh/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/small_map.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

int int_of(std::size_t n) { return static_cast<int>(n); }

/// Nodes of a grain's surface: those of its vertices, edges and faces, each once.
int count_surface_nodes(const Topology& topology, const BoundaryMesher& boundary, int grain) {
  std::vector<int> edges, vertices;
  std::size_t count = 0;
  for (int f : topology.cell_faces[grain]) {
    const auto& list = topology.faces[f].edges;
    edges.insert(edges.end(), list.begin(), list.end());
    count += boundary.faces()[f].inner_nodes.size();
  }
  const auto make_unique = [](std::vector<int>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  };
  make_unique(edges);
  for (int e : edges) {
    count += boundary.edges()[e].nodes.size() - 2;
    for (int v : topology.edges[e].vertices) vertices.push_back(v);
  }
  make_unique(vertices);
  return int_of(count + vertices.size());
}

/// Where the nodes and elements of each entity begin.
struct Layout {
  BoundaryNumbers corners;
  std::vector<int> line_first;      ///< [edges] first line
  std::vector<int> triangle_first;  ///< [faces + 1] first triangle
  std::vector<int> inner_first;     ///< [grains + 1] first corner node inside the grain
  std::vector<int> element_first;   ///< [grains + 1] first tetrahedron
  int line_mids = 0;                ///< mid node of the first line; the others follow
  std::vector<int> face_mids;       ///< [faces] first mid node inside the face
  int grain_mids = 0;               ///< first mid node inside a grain
};

Layout lay_out(const Topology& topology, const BoundaryMesher& boundary,
               const std::vector<VolumeMesh>& volumes, int order, int threads) {
  Layout layout;
  layout.corners = boundary.numbers();
  std::size_t lines = 0, triangles = 0, elements = 0;
  for (const auto& e : boundary.edges()) {
    layout.line_first.push_back(int_of(lines));
    lines += e.nodes.size() - 1;
  }
  layout.line_first.push_back(int_of(lines));
  for (const auto& f : boundary.faces()) {
    layout.triangle_first.push_back(int_of(triangles));
    triangles += f.triangles.size();
  }
  layout.triangle_first.push_back(int_of(triangles));
  std::vector<int> on_surface(volumes.size());
  core::parallel_for(threads, volumes.size(), [&](std::size_t g) {
    on_surface[g] = count_surface_nodes(topology, boundary, int_of(g));
  });
  std::size_t next = static_cast<std::size_t>(layout.corners.count);
  for (std::size_t g = 0; g < volumes.size(); ++g) {
    layout.inner_first.push_back(int_of(next));
    layout.element_first.push_back(int_of(elements));
    next += volumes[g].nodes.size() - static_cast<std::size_t>(on_surface[g]);
    elements += volumes[g].tetrahedra.size();
  }
  layout.inner_first.push_back(int_of(next));
  layout.element_first.push_back(int_of(elements));
  layout.line_mids = int_of(next);
  if (order == 2) next += lines;
  for (const auto& f : boundary.faces()) {
    layout.face_mids.push_back(int_of(next));
    if (order == 2) next += f.inner_edges.size();
  }
  layout.grain_mids = int_of(next);
  // Each tetrahedron has at most six mid nodes of its own.
  if (next + 6 * elements > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw core::RecoverableError(fmt::format(
        "mesh: {} elements have more nodes than can be numbered; take larger elements", elements));
  return layout;
}

/// Pairs of nodes: those of vertices, inner nodes of edges, then those of faces, from lines and
/// triangles, which translates have in one order.
void pair_nodes(Mesh& mesh, const Layout& layout) {
  const auto& periodic = mesh.topology.periodic;
  if (periodic.empty()) return;
  auto& pairs = mesh.periodic_nodes;
  std::vector<char> known(mesh.nodes.size(), false);
  const auto pair = [&](int slave, int master, const Shift& shift) {
    if (slave < 0 || known[slave]) return;
    known[slave] = true;
    pairs.push_back({slave, master, shift});
  };
  for (const auto& p : periodic.vertices)
    pair(mesh.vertex_nodes[p.slave], mesh.vertex_nodes[p.master], p.shift);
  for (const int n : mesh.vertex_nodes) known[n] = true;
  for (const auto& p : periodic.edges)
    for (int i = layout.line_first[p.slave]; i < layout.line_first[p.slave + 1]; ++i)
      for (int k = 0; k < 3; ++k)
        pair(mesh.lines[i][k],
             mesh.lines[layout.line_first[p.master] + i - layout.line_first[p.slave]][k], p.shift);
  for (const auto& line : mesh.lines)
    for (const int n : line)
      if (n >= 0) known[n] = true;
  constexpr std::array<int, 6> turned{0, 2, 1, 5, 4, 3};
  for (const auto& p : periodic.faces)
    for (int i = layout.triangle_first[p.slave]; i < layout.triangle_first[p.slave + 1]; ++i)
      for (int k = 0; k < 6; ++k)
        pair(mesh.triangles[i][k],
             mesh.triangles[layout.triangle_first[p.master] + i - layout.triangle_first[p.slave]]
                           [turned[k]],
             p.shift);
  std::sort(pairs.begin(), pairs.end(),
            [](const PeriodicPair& a, const PeriodicPair& b) { return a.slave < b.slave; });
}

class Assembler {
 public:
  Assembler(const Geometry& geometry, const BoundaryMesher& boundary,
            std::vector<VolumeMesh>&& volumes, const Vec3& scale, int order, int threads)
      : boundary_(boundary),
        volumes_(volumes),
        scale_(scale),
        threads_(threads),
        layout_(lay_out(geometry.topology, boundary, volumes, order, threads)) {
    mesh_.order = order;
    mesh_.topology = geometry.topology;
    mesh_.domain = geometry.domain;
    mesh_.size = geometry.size;
  }

  Mesh run() {
    for (int v = 0; v < mesh_.topology.vertex_count; ++v) mesh_.vertex_nodes.push_back(v);
    add_boundary();
    add_corners();
    if (mesh_.order == 2) add_mids();
    pair_nodes(mesh_, layout_);
    return std::move(mesh_);
  }

 private:
  void add_boundary() {
    const auto lines = static_cast<std::size_t>(layout_.line_first.back());
    const auto triangles = static_cast<std::size_t>(layout_.triangle_first.back());
    mesh_.lines.resize(lines);
    mesh_.line_edge.resize(lines);
    mesh_.triangles.resize(triangles);
    mesh_.triangle_face.resize(triangles);
    mesh_.nodes = boundary_.positions(layout_.corners);
    mesh_.nodes.resize(static_cast<std::size_t>(layout_.grain_mids));
    core::parallel_for(threads_, boundary_.edges().size(),
                       [this](std::size_t e) { add_lines(int_of(e)); });
    core::parallel_for(threads_, boundary_.faces().size(),
                       [this](std::size_t f) { add_triangles(int_of(f)); });
  }

  void add_lines(int e) {
    const auto& edge = boundary_.edges()[e];
    const int last = int_of(edge.nodes.size()) - 1;
    const auto node = [&](int i) {
      if (i == 0 || i == last) return mesh_.topology.edges[e].vertices[i == 0 ? 0 : 1];
      return layout_.corners.edge_first[e] + i - 1;
    };
    for (int i = 0; i < last; ++i) {
      const int line = layout_.line_first[e] + i;
      const int mid = mesh_.order == 2 ? layout_.line_mids + line : -1;
      mesh_.lines[line] = {node(i), node(i + 1), mid};
      mesh_.line_edge[line] = e;
      if (mid >= 0) mesh_.nodes[mid] = edge.mids[i];
    }
  }

  /// Mid nodes of the lines along the loop of a face.
  std::vector<int> loop_mids(int f) const {
    const auto& face = mesh_.topology.faces[f];
    std::vector<int> mids;
    for (std::size_t i = 0; i < face.edges.size(); ++i) {
      const int first = layout_.line_first[face.edges[i]];
      const int count = layout_.line_first[face.edges[i] + 1] - first;
      for (int k = 0; k < count; ++k)
        mids.push_back(layout_.line_mids + first + (face.forward[i] ? k : count - 1 - k));
    }
    return mids;
  }

  void add_triangles(int f) {
    const auto& face = boundary_.faces()[f];
    const auto nodes = boundary_.face_nodes(f, layout_.corners);
    const auto on_loop = loop_mids(f);
    const int n = face.boundary_count, first_mid = layout_.face_mids[f];
    const auto mid_of = [&](int a, int b) {
      if (mesh_.order == 1) return -1;
      if (a > b) std::swap(a, b);
      const auto at = std::lower_bound(face.inner_edges.begin(), face.inner_edges.end(),
                                       std::array{a, b}, [](const auto& e, const auto& wanted) {
                                         return std::array{e.a, e.b} < wanted;
                                       });
      if (at != face.inner_edges.end() && at->a == a && at->b == b)
        return first_mid + int_of(static_cast<std::size_t>(at - face.inner_edges.begin()));
      if (b == a + 1 && b < n) return on_loop[a];
      if (a == 0 && b == n - 1) return on_loop[b];
      throw core::InternalError("mesh assembly: an edge has no mid node");
    };
    for (std::size_t i = 0; i < face.triangles.size(); ++i) {
      const auto& t = face.triangles[i];
      const int triangle = layout_.triangle_first[f] + int_of(i);
      mesh_.triangles[triangle] = {nodes[t[0]],        nodes[t[1]],        nodes[t[2]],
                                   mid_of(t[0], t[1]), mid_of(t[1], t[2]), mid_of(t[2], t[0])};
      mesh_.triangle_face[triangle] = f;
    }
    if (mesh_.order == 2)
      for (std::size_t k = 0; k < face.inner_edges.size(); ++k)
        mesh_.nodes[first_mid + int_of(k)] = face.inner_edges[k].mid;
  }

  void add_corners() {
    const auto elements = static_cast<std::size_t>(layout_.element_first.back());
    mesh_.tetrahedra.resize(elements);
    mesh_.tetrahedron_cell.resize(elements);
    core::parallel_for(threads_, volumes_.size(), [this](std::size_t g) {
      add_corners(int_of(g));
      volumes_[g] = {};
    });
  }

  /// A grain's inner nodes and tetrahedra, corners only.
  void add_corners(int grain) {
    const auto& volume = volumes_[grain];
    const int first = layout_.inner_first[grain];
    const int inner = layout_.inner_first[grain + 1] - first;
    const int surface = int_of(volume.nodes.size()) - inner;
    const auto numbers = surface_numbers(grain, static_cast<std::size_t>(surface));
    if (int_of(numbers.size()) != surface)
      throw core::InternalError(fmt::format("mesh assembly: grain {} has {} surface nodes, not {}",
                                            grain + 1, numbers.size(), surface));
    for (int i = 0; i < inner; ++i)
      mesh_.nodes[first + i] = volume.nodes[surface + i].cwiseQuotient(scale_);
    for (std::size_t k = 0; k < volume.tetrahedra.size(); ++k) {
      const int element = layout_.element_first[grain] + int_of(k);
      auto& t = mesh_.tetrahedra[element];
      t.fill(-1);
      for (int i = 0; i < 4; ++i) {
        const int local = volume.tetrahedra[k][i];
        t[i] = local < surface ? numbers[local] : first + local - surface;
      }
      mesh_.tetrahedron_cell[element] = grain;
    }
  }

  /// Nodes of a grain's surface in the order of grain_surface.
  std::vector<int> surface_numbers(int grain, std::size_t expected) const {
    std::vector<int> numbers;
    numbers.reserve(expected);
    SmallMap seen(expected);
    for (int f : mesh_.topology.cell_faces[grain])
      for (int i = layout_.triangle_first[f]; i < layout_.triangle_first[f + 1]; ++i)
        for (int k = 0; k < 3; ++k) {
          const int node = mesh_.triangles[i][k];
          if (seen.insert(static_cast<std::uint64_t>(node), 0).second) numbers.push_back(node);
        }
    return numbers;
  }

  /// Mid nodes of the tetrahedra: those of the surface are there; of those inside, grains first
  /// count theirs, from 0, and then know where they begin.
  void add_mids() {
    std::vector<int> first(volumes_.size() + 1, 0);
    core::parallel_for(threads_, volumes_.size(),
                       [&](std::size_t g) { first[g + 1] = find_mids(int_of(g)); });
    first[0] = layout_.grain_mids;
    for (std::size_t g = 0; g < volumes_.size(); ++g) first[g + 1] += first[g];
    mesh_.nodes.resize(static_cast<std::size_t>(first.back()));
    core::parallel_for(threads_, volumes_.size(), [&](std::size_t g) {
      for (int e = layout_.element_first[g]; e < layout_.element_first[g + 1]; ++e)
        place_mids(mesh_.tetrahedra[e], first[g]);
    });
  }

  /// Sets the mid nodes of a grain's tetrahedra, those inside as -2 - (their number in the grain);
  /// how many there are inside.
  int find_mids(int grain) {
    const int elements = layout_.element_first[grain + 1] - layout_.element_first[grain];
    SmallMap mids(2 * static_cast<std::size_t>(elements));
    for (int f : mesh_.topology.cell_faces[grain])
      for (int i = layout_.triangle_first[f]; i < layout_.triangle_first[f + 1]; ++i)
        for (int k = 0; k < 3; ++k) {
          const auto& t = mesh_.triangles[i];
          const int a = t[triangle_edges[k][0]], b = t[triangle_edges[k][1]];
          if (mids.insert(pair_key(a, b), t[3 + k]).first != t[3 + k])
            throw core::InternalError(fmt::format(
                "mesh assembly: nodes {} and {} are joined by two edges of the surfaces", a + 1,
                b + 1));
        }
    int inside = 0;
    for (int e = layout_.element_first[grain]; e < layout_.element_first[grain + 1]; ++e) {
      auto& t = mesh_.tetrahedra[e];
      for (int k = 0; k < 6; ++k) {
        const auto key = pair_key(t[tetrahedron_edges[k][0]], t[tetrahedron_edges[k][1]]);
        const auto [mid, added] = mids.insert(key, -2 - inside);
        inside += added;
        t[4 + k] = mid;
      }
    }
    return inside;
  }

  void place_mids(std::array<int, 10>& t, int first) {
    for (int k = 0; k < 6; ++k) {
      if (t[4 + k] >= 0) continue;
      t[4 + k] = first - 2 - t[4 + k];
      mesh_.nodes[t[4 + k]] =
          (mesh_.nodes[t[tetrahedron_edges[k][0]]] + mesh_.nodes[t[tetrahedron_edges[k][1]]]) / 2;
    }
  }

  const BoundaryMesher& boundary_;
  std::vector<VolumeMesh>& volumes_;
  Vec3 scale_;
  int threads_;
  Layout layout_;
  Mesh mesh_;
};

}  // namespace

GrainSurface grain_surface(const Topology& topology, const BoundaryMesher& boundary,
                           const BoundaryNumbers& numbers, const std::vector<Vec3>& positions,
                           int grain, const Vec3& scale) {
  GrainSurface surface;
  std::size_t triangles = 0;
  for (int f : topology.cell_faces[grain]) triangles += boundary.faces()[f].triangles.size();
  surface.mesh.triangles.reserve(triangles);
  surface.faces.reserve(triangles);
  SmallMap local(triangles / 2 + 2);  // by Euler's formula
  for (int f : topology.cell_faces[grain]) {
    const bool outward = topology.faces[f].cells[0] == grain;
    const auto nodes = boundary.face_nodes(f, numbers);
    for (const auto& t : boundary.faces()[f].triangles) {
      std::array<int, 3> triangle{};
      for (int i = 0; i < 3; ++i) {
        const int number = nodes[t[i]];
        const auto [at, added] =
            local.insert(static_cast<std::uint64_t>(number), int_of(surface.numbers.size()));
        if (added) {
          surface.numbers.push_back(number);
          surface.mesh.nodes.push_back(positions[number].cwiseProduct(scale));
        }
        triangle[i] = at;
      }
      if (!outward) std::swap(triangle[1], triangle[2]);
      surface.mesh.triangles.push_back(triangle);
      surface.faces.push_back(f);
    }
  }
  return surface;
}

Mesh assemble(const Geometry& geometry, const BoundaryMesher& boundary,
              std::vector<VolumeMesh>&& volumes, const Vec3& scale, int order, int threads) {
  return Assembler(geometry, boundary, std::move(volumes), scale, order, threads).run();
}

}  // namespace polyslip::mesh
