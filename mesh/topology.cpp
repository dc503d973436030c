#include "mesh/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/error.hpp"
#include "mesh/cell_surface.hpp"

namespace polyslip::mesh {
namespace {

[[noreturn]] void fail(const std::string& what) { throw core::InternalError("topology: " + what); }

int count(std::size_t n) { return static_cast<int>(n); }

bool in_range(int id, int n) { return id >= 0 && id < n; }

int start_of(const Topology& t, const TopologyFace& face, std::size_t i) {
  return t.edges[face.edges[i]].vertices[face.forward[i] ? 0 : 1];
}

int end_of(const Topology& t, const TopologyFace& face, std::size_t i) {
  return t.edges[face.edges[i]].vertices[face.forward[i] ? 1 : 0];
}

void check_edges(const Topology& t) {
  for (int e = 0; e < count(t.edges.size()); ++e) {
    const auto& [a, b] = t.edges[e].vertices;
    if (!in_range(a, t.vertex_count) || !in_range(b, t.vertex_count))
      fail(fmt::format("edge {} has vertices {} and {} of {}", e, a, b, t.vertex_count));
    if (a == b) fail(fmt::format("edge {} has identical ends {}", e, a));
  }
}

void check_loop(const Topology& t, int f) {
  const auto& face = t.faces[f];
  const std::size_t n = face.edges.size();
  if (n < 2) fail(fmt::format("face {} has {} edges", f, n));
  if (face.forward.size() != n)
    fail(fmt::format("face {} has {} edges and {} directions", f, n, face.forward.size()));
  for (const int e : face.edges)
    if (!in_range(e, count(t.edges.size())))
      fail(fmt::format("face {} has edge {} of {}", f, e, t.edges.size()));
  std::vector<int> vertices;
  for (std::size_t i = 0; i < n; ++i) {
    if (end_of(t, face, i) != start_of(t, face, (i + 1) % n))
      fail(fmt::format("loop of face {} is open after edge {}", f, face.edges[i]));
    vertices.push_back(start_of(t, face, i));
  }
  std::sort(vertices.begin(), vertices.end());
  const auto twice = std::adjacent_find(vertices.begin(), vertices.end());
  if (twice != vertices.end()) fail(fmt::format("face {} meets vertex {} twice", f, *twice));
}

void check_face_cells(const Topology& t, int f, int domain_faces, bool periodic) {
  const auto& face = t.faces[f];
  const auto [inside, outside] = face.cells;
  if (!in_range(inside, t.cell_count()) || outside >= t.cell_count() || outside < -1)
    fail(fmt::format("face {} lies between cells {} and {} of {}", f, inside, outside,
                     t.cell_count()));
  if (inside == outside) fail(fmt::format("face {} has cell {} on both sides", f, inside));
  if (face.domain_face < -1 || face.domain_face >= domain_faces)
    fail(fmt::format("face {} has domain face {}", f, face.domain_face));
  const bool outer = face.domain_face >= 0 || periodic;
  if ((outside == -1) != outer || (face.domain_face >= 0 && periodic))
    fail(fmt::format("face {} has outer cell {} and domain face {}{}", f, outside, face.domain_face,
                     periodic ? ", and is periodic" : ""));
}

// Each side of a face must be listed by its cell, once.
void check_cell_lists(const Topology& t) {
  std::vector<int> listed(t.faces.size(), 0);
  for (int c = 0; c < t.cell_count(); ++c) {
    auto faces = t.cell_faces[c];
    std::sort(faces.begin(), faces.end());
    if (std::adjacent_find(faces.begin(), faces.end()) != faces.end())
      fail(fmt::format("cell {} lists a face twice", c));
    for (const int f : faces) {
      if (!in_range(f, count(t.faces.size())))
        fail(fmt::format("cell {} has face {} of {}", c, f, t.faces.size()));
      if (t.faces[f].cells[0] != c && t.faces[f].cells[1] != c)
        fail(fmt::format("cell {} lists face {}, which is not its own", c, f));
      ++listed[f];
    }
  }
  for (int f = 0; f < count(t.faces.size()); ++f)
    if (listed[f] != (t.faces[f].cells[1] >= 0 ? 2 : 1))
      fail(fmt::format("face {} is listed by {} cells", f, listed[f]));
}

void check_pair_list(const char* what, const std::vector<PeriodicPair>& pairs, int n) {
  std::vector<char> is_slave(n, 0);
  int last = -1;
  for (const auto& pair : pairs) {
    if (!in_range(pair.slave, n) || !in_range(pair.master, n) || pair.slave <= last)
      fail(
          fmt::format("{} pair of slave {} and master {} of {}", what, pair.slave, pair.master, n));
    is_slave[last = pair.slave] = 1;
  }
  for (const auto& pair : pairs)
    if (is_slave[pair.master])
      fail(fmt::format("{} {} is a master and a slave", what, pair.master));
}

// Where each entity's master is from there, and the master.
struct Masters {
  std::vector<int> of;
  std::vector<Shift> shift;
  Masters(const std::vector<PeriodicPair>& pairs, int n) : of(n), shift(n, Shift{}) {
    std::iota(of.begin(), of.end(), 0);
    for (const auto& pair : pairs) {
      of[pair.slave] = pair.master;
      shift[pair.slave] = pair.shift;
    }
  }
};

// Ends of a slave edge, and edges of a slave face, are translates of its master's by the same
// shift.
void check_translates(const Topology& t) {
  const Masters vertices(t.periodic.vertices, t.vertex_count);
  const Masters edges(t.periodic.edges, count(t.edges.size()));
  for (const auto& pair : t.periodic.edges)
    for (int i = 0; i < 2; ++i) {
      const int a = t.edges[pair.slave].vertices[i], b = t.edges[pair.master].vertices[i];
      if (vertices.of[a] != vertices.of[b] || vertices.shift[a] - vertices.shift[b] != pair.shift)
        fail(fmt::format("edge {} is no translate of edge {}", pair.slave, pair.master));
    }
  for (const auto& pair : t.periodic.faces) {
    const auto &slave = t.faces[pair.slave], &master = t.faces[pair.master];
    const std::size_t n = slave.edges.size();
    bool same = n == master.edges.size() && slave.cells[1] == -1 && master.cells[1] == -1;
    for (std::size_t i = 0; same && i < n; ++i) {
      const int a = slave.edges[i], b = master.edges[n - 1 - i];
      same = slave.forward[i] != master.forward[n - 1 - i] && edges.of[a] == edges.of[b] &&
             edges.shift[a] - edges.shift[b] == pair.shift;
    }
    if (!same) fail(fmt::format("face {} is no translate of face {}", pair.slave, pair.master));
  }
}

// Which faces are periodic, once the pairs hold.
std::vector<char> check_periodic(const Topology& t) {
  const auto& p = t.periodic;
  check_pair_list("vertex", p.vertices, t.vertex_count);
  check_pair_list("edge", p.edges, count(t.edges.size()));
  check_pair_list("face", p.faces, count(t.faces.size()));
  std::vector<char> periodic(t.faces.size(), 0);
  for (const auto& pair : p.faces)
    for (const int f : {pair.slave, pair.master})
      if (std::exchange(periodic[f], 1)) fail(fmt::format("face {} is in two pairs", f));
  check_translates(t);
  return periodic;
}

void check_cell_surface(const Topology& t, int c) {
  const auto [kind, where] = surface_fault(t, c);
  switch (kind) {
    case SurfaceFault::Kind::none:
      return;
    case SurfaceFault::Kind::edge_not_shared:
      fail(fmt::format("edge {} is not in exactly two faces of cell {}", where, c));
    case SurfaceFault::Kind::turned_about:
      fail(fmt::format("faces of cell {} disagree in orientation at edge {}", c, where));
    case SurfaceFault::Kind::parts:
      fail(fmt::format("the surface of cell {} is in {} parts", c, where));
    case SurfaceFault::Kind::touching:
      fail(fmt::format("the surface of cell {} touches itself at vertex {}", c, where));
  }
}

void check_all_used(const Topology& t) {
  std::vector<char> edge_used(t.edges.size(), 0), vertex_used(t.vertex_count, 0);
  for (const auto& face : t.faces)
    for (const int e : face.edges) {
      edge_used[e] = 1;
      for (const int v : t.edges[e].vertices) vertex_used[v] = 1;
    }
  const auto edge = std::find(edge_used.begin(), edge_used.end(), 0);
  if (edge != edge_used.end()) fail(fmt::format("edge {} is unused", edge - edge_used.begin()));
  const auto vertex = std::find(vertex_used.begin(), vertex_used.end(), 0);
  if (vertex != vertex_used.end())
    fail(fmt::format("vertex {} is unused", vertex - vertex_used.begin()));
}

}  // namespace

std::vector<int> Topology::face_vertices(int face) const {
  std::vector<int> vertices;
  const auto& f = faces[face];
  vertices.reserve(f.edges.size());
  for (std::size_t i = 0; i < f.edges.size(); ++i) vertices.push_back(start_of(*this, f, i));
  return vertices;
}

void Topology::check(int domain_faces) const {
  if (cell_faces.empty()) fail("no cells");
  check_edges(*this);
  for (int f = 0; f < count(faces.size()); ++f) check_loop(*this, f);
  const auto is_periodic = check_periodic(*this);
  for (int f = 0; f < count(faces.size()); ++f)
    check_face_cells(*this, f, domain_faces, is_periodic[f]);
  check_cell_lists(*this);
  for (int c = 0; c < cell_count(); ++c) check_cell_surface(*this, c);
  check_all_used(*this);
}

}  // namespace polyslip::mesh
