// Neper's .tess format, version 3.5, as its reference manual describes it: ids from 1; a face of a
// polyhedron is negative if its normal points into the polyhedron, an edge of a face if the loop
// runs against it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/file.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

class TessWriter {
 public:
  explicit TessWriter(const Tessellation& tessellation) : tess_(tessellation) {}

  std::string text() {
    add("***tess\n **format\n   3.5\n **general\n   3 standard\n");
    cells();
    vertices();
    edges();
    faces();
    polyhedra();
    domain();
    add("***end\n");
    return std::move(text_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }

  // 17 digits: reading the file gives the same numbers.
  void point(const Vec3& x) { add(" {:.17g} {:.17g} {:.17g}", x.x(), x.y(), x.z()); }

  void cells() {
    add(" **cell\n  {}\n  *seed\n", tess_.seeds.size());
    for (std::size_t i = 0; i < tess_.seeds.size(); ++i) {
      add("   {}", i + 1);
      point(tess_.seeds[i]);
      add(" 0\n");
    }
  }

  void vertices() {
    add(" **vertex\n  {}\n", tess_.vertices.size());
    for (std::size_t i = 0; i < tess_.vertices.size(); ++i) {
      add("   {}", i + 1);
      point(tess_.vertices[i]);
      add(" 0\n");
    }
  }

  void edges() {
    const auto& all = tess_.topology.edges;
    add(" **edge\n  {}\n", all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      add("   {} {} {} 0\n", i + 1, all[i].vertices[0] + 1, all[i].vertices[1] + 1);
  }

  void faces() {
    const auto& all = tess_.topology.faces;
    add(" **face\n  {}\n", all.size());
    for (int f = 0; f < static_cast<int>(all.size()); ++f) {
      const auto loop = tess_.topology.face_vertices(f);
      add("   {} {}", f + 1, loop.size());
      for (const int v : loop) add(" {}", v + 1);
      add("\n     {}", loop.size());
      for (std::size_t i = 0; i < all[f].edges.size(); ++i)
        add(" {}", (all[f].forward[i] ? 1 : -1) * (all[f].edges[i] + 1));
      const Plane& plane = tess_.face_planes[f];
      add("\n     {:.17g}", plane.offset);
      point(plane.normal);
      add("\n");
      face_point(f, loop);
    }
  }

  // State 1 and the master point (0 the barycentre, i the i-th vertex) if the face left its plane.
  void face_point(int f, const std::vector<int>& loop) {
    std::vector<Vec3> points;
    double distance = 0;
    for (const int v : loop) {
      points.push_back(tess_.vertices[v]);
      const Plane& plane = tess_.face_planes[f];
      distance = std::max(distance, std::abs(plane.normal.dot(points.back()) - plane.offset));
    }
    if (distance > 1e-9) {
      const int master = tess_.face_masters[f];
      add("     1 {}", master + 1);
      point(fan_master(points, master));
      add("\n");
    } else {
      add("     0 0 0 0 0\n");
    }
  }

  void polyhedra() {
    const auto& t = tess_.topology;
    add(" **polyhedron\n  {}\n", t.cell_count());
    for (int c = 0; c < t.cell_count(); ++c) {
      add("   {} {}", c + 1, t.cell_faces[c].size());
      for (const int f : t.cell_faces[c]) add(" {}", (t.faces[f].cells[0] == c ? 1 : -1) * (f + 1));
      add("\n");
    }
  }

  double corner_coordinate(int axis, bool high) const { return high ? tess_.size[axis] : 0.0; }

  bool on_box_face(int vertex, int box_face) const {
    const int axis = box_face / 2;
    return tess_.vertices[vertex][axis] == corner_coordinate(axis, box_face % 2 == 1);
  }

  // Ids (from 1) of what lies in all the given faces of the box.
  std::vector<int> vertices_on(const std::vector<int>& box_faces) const {
    std::vector<int> found;
    for (int v = 0; v < tess_.topology.vertex_count; ++v)
      if (std::all_of(box_faces.begin(), box_faces.end(), [&](int b) { return on_box_face(v, b); }))
        found.push_back(v + 1);
    return found;
  }

  std::vector<int> edges_on(int box_face_1, int box_face_2) const {
    std::vector<int> found;
    const auto& all = tess_.topology.edges;
    for (std::size_t e = 0; e < all.size(); ++e) {
      const auto [a, b] = all[e].vertices;
      if (on_box_face(a, box_face_1) && on_box_face(b, box_face_1) && on_box_face(a, box_face_2) &&
          on_box_face(b, box_face_2))
        found.push_back(static_cast<int>(e) + 1);
    }
    return found;
  }

  std::vector<int> faces_on(int box_face) const {
    std::vector<int> found;
    const auto& all = tess_.topology.faces;
    for (std::size_t f = 0; f < all.size(); ++f)
      if (all[f].domain_face == box_face) found.push_back(static_cast<int>(f) + 1);
    return found;
  }

  void list(const std::string& indent, const std::vector<int>& ids) {
    add("{}{}", indent, ids.size());
    for (const int id : ids) add(" {}", id);
    add("\n");
  }

  // Corner i of the box: bits 0, 1, 2 of i say whether x, y, z are at the far side.
  void domain() {
    add(" **domain\n  *general\n   cube\n  *vertex\n   8\n");
    for (int corner = 0; corner < 8; ++corner) {
      std::vector<int> box_faces;
      std::string label;
      Vec3 x;
      for (int axis = 0; axis < 3; ++axis) {
        const int high = corner >> axis & 1;
        box_faces.push_back(2 * axis + high);
        label += box_face_names[2 * axis + high];
        x[axis] = corner_coordinate(axis, high == 1);
      }
      add("   {}", corner + 1);
      point(x);
      add(" {}\n", label);
      list("      ", vertices_on(box_faces));
    }
    domain_edges();
    domain_faces();
  }

  struct BoxEdge {
    std::array<int, 2> corners, box_faces;
  };

  static std::vector<BoxEdge> box_edges() {
    std::vector<BoxEdge> found;
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 8; ++corner) {
        if (corner >> axis & 1) continue;
        const int p = axis == 0 ? 1 : 0, q = axis == 2 ? 1 : 2;
        found.push_back(
            {{corner, corner | 1 << axis}, {2 * p + (corner >> p & 1), 2 * q + (corner >> q & 1)}});
      }
    return found;
  }

  void domain_edges() {
    add("  *edge\n   12\n");
    int id = 0;
    for (const auto& e : box_edges()) {
      add("   {} 2 {} {}\n     line\n     0\n     {}{}\n", ++id, e.corners[0] + 1, e.corners[1] + 1,
          box_face_names[e.box_faces[0]], box_face_names[e.box_faces[1]]);
      list("     ", edges_on(e.box_faces[0], e.box_faces[1]));
    }
  }

  void domain_faces() {
    add("  *face\n   6\n");
    const auto edges = box_edges();
    for (int b = 0; b < 6; ++b) {
      const int axis = b / 2, p = (axis + 1) % 3, q = (axis + 2) % 3;
      const int base = (b % 2) << axis;
      const std::array<int, 4> corners{base, base | 1 << p, base | 1 << p | 1 << q, base | 1 << q};
      add("   {} 4", b + 1);
      for (const int c : corners) add(" {}", c + 1);
      add("\n     4");
      for (std::size_t i = 0; i < 4; ++i) {
        const int from = corners[i], to = corners[(i + 1) % 4];
        for (std::size_t e = 0; e < edges.size(); ++e)
          if (edges[e].corners == std::array{std::min(from, to), std::max(from, to)})
            add(" {}", e + 1);
      }
      const double sign = b % 2 ? -1 : 1;
      add("\n     plane\n     4 {:.17g}", b % 2 ? -tess_.size[axis] : 0.0);
      point(sign * Vec3::Unit(axis));
      add("\n     {}\n", box_face_names[b]);
      list("     ", faces_on(b));
    }
  }

  const Tessellation& tess_;
  std::string text_;
};

}  // namespace

void write_tess(const Tessellation& tessellation, const std::string& path) {
  core::write_file(path, TessWriter(tessellation).text());
}

}  // namespace polyslip::mesh
