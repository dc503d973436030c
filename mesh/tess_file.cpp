// Neper's .tess format, version 3.5, as its reference manual describes it: ids from 1; a face of a
// polyhedron is negative if its normal points into the polyhedron, an edge of a face if the loop
// runs against it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "core/error.hpp"
#include "core/file.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/orientation_block.hpp"
#include "mesh/tess_writer.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

class TessWriter {
 public:
  TessWriter(const Tessellation& tessellation, const std::string& path, const TessNotes& notes)
      : tess_(tessellation), domain_(tessellation.domain), notes_(notes), out_(path) {}

  void write() {
    add("***tess\n **format\n   3.5\n **general\n   3 standard\n");
    cells();
    vertices();
    edges();
    faces();
    polyhedra();
    domain();
    if (!tess_.topology.periodic.empty()) periodicity();
    add("***end\n");
    out_.finish();
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    text_.clear();
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    out_.put(std::string_view(text_.data(), text_.size()));
  }

  // Reading the file gives the same numbers.
  void number(double x) {
    out_.put(' ');
    out_.put(x);
  }
  void point(const Vec3& x) {
    for (int i = 0; i < 3; ++i) number(x[i]);
  }

  void cells() {
    add(" **cell\n  {}\n", tess_.seeds.size());
    if (!counts_from_one(notes_.ids)) numbers("*id", notes_.ids);
    if (!notes_.crystal.empty()) add("  *crysym\n   {}\n", notes_.crystal);
    add("  *seed\n");
    for (std::size_t i = 0; i < tess_.seeds.size(); ++i) {
      add("   {}", i + 1);
      point(tess_.seeds[i]);
      number(notes_.seed_weights.empty() ? 0 : notes_.seed_weights[i]);
      add("\n");
    }
    if (!notes_.groups.empty()) numbers("*group", notes_.groups);
    if (notes_.orientations.empty()) return;
    add("  *ori\n   {}\n", written_descriptor);
    for (const core::Quaternion& q : notes_.orientations) {
      add("  ");
      put_orientation(out_, q);
      add("\n");
    }
  }

  /// As cells do in files without ids.
  static bool counts_from_one(std::span<const int> ids) {
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] != static_cast<int>(i) + 1) return false;
    return true;
  }

  void numbers(const char* key, std::span<const int> list) {
    add("  {}\n  ", key);
    for (const int x : list) add(" {}", x);
    add("\n");
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
      add("\n    ");
      number(plane.offset);
      point(plane.normal);
      add("\n");
      face_point(f, loop);
    }
  }

  // State 1 and the master point (0 the barycentre, i the i-th vertex) if the face left its plane
  // or has another master point than most.
  void face_point(int f, const std::vector<int>& loop) {
    std::vector<Vec3> points;
    double distance = 0;
    for (const int v : loop) {
      points.push_back(tess_.vertices[v]);
      const Plane& plane = tess_.face_planes[f];
      distance = std::max(distance, std::abs(plane.normal.dot(points.back()) - plane.offset));
    }
    if (const int master = tess_.face_masters[f]; distance > 1e-9 || master >= 0) {
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

  // Ids (from 1) of what lies in all the given faces of the domain.
  // `on_first`: those on the first of the faces.
  static std::vector<int> lying_on(const DomainFaceLists& lists, const std::vector<int>& on_first,
                                   const std::vector<int>& domain_faces) {
    std::vector<int> found;
    for (const int i : on_first)
      if (std::all_of(domain_faces.begin(), domain_faces.end(), [&](int d) {
            return std::binary_search(lists[i].begin(), lists[i].end(), d);
          }))
        found.push_back(i + 1);
    return found;
  }

  // For each face of the domain, what lies in it, ascending.
  std::vector<std::vector<int>> by_face(const DomainFaceLists& lists, std::size_t count) const {
    std::vector<std::vector<int>> found(domain_.faces.size());
    for (std::size_t i = 0; i < count; ++i)
      for (const int d : lists[i]) found[d].push_back(static_cast<int>(i));
    return found;
  }

  std::vector<int> faces_on(int domain_face) const {
    std::vector<int> found;
    const auto& all = tess_.topology.faces;
    for (std::size_t f = 0; f < all.size(); ++f)
      if (all[f].domain_face == domain_face) found.push_back(static_cast<int>(f) + 1);
    return found;
  }

  void list(const std::string& indent, const std::vector<int>& ids) {
    add("{}{}", indent, ids.size());
    for (const int id : ids) add(" {}", id);
    add("\n");
  }

  std::string label(const std::vector<int>& domain_faces) const {
    std::string text;
    for (const int d : domain_faces) text += domain_.faces[d].name;
    return text;
  }

  /// Neper's names; a general convex body is one of planes.
  std::string domain_type() const {
    if (domain_.is_box()) return "cube";
    return domain_.shape == "cylinder" || domain_.shape == "sphere" ? domain_.shape : "planes";
  }

  void domain() {
    add(" **domain\n  *general\n   {}\n", domain_type());
    domain_vertices();
    domain_edges();
    domain_faces();
  }

  void periodicity() {
    const auto& on = domain_.periodic;
    add(" **periodicity\n  *general\n   {:d} {:d} {:d}\n  ", on[0], on[1], on[2]);
    for (int k = 0; k < 3; ++k) number(on[k] ? domain_.size[k] : 0);
    add("\n  *seed\n   0\n");
    const auto& p = tess_.topology.periodic;
    translates("*vertex", p.vertices, "");
    translates("*edge", p.edges, " 1");
    translates("*face", p.faces, " -1");
  }

  void translates(const char* key, const std::vector<PeriodicPair>& pairs,
                  const char* orientation) {
    add("  {}\n   {}\n", key, pairs.size());
    for (const auto& [slave, master, shift] : pairs)
      add("   {} {} {} {} {}{}\n", slave + 1, master + 1, shift[0], shift[1], shift[2],
          orientation);
  }

  void domain_vertices() {
    const auto on_faces = domain_faces_of_vertices(tess_.topology);
    const auto in_face = by_face(on_faces, tess_.vertices.size());
    std::vector<std::vector<int>> around(domain_.vertices.size());
    for (int d = 0; d < domain_.face_count(); ++d)
      for (const int v : domain_.faces[d].loop) around[v].push_back(d);
    add("  *vertex\n   {}\n", domain_.vertices.size());
    for (std::size_t v = 0; v < domain_.vertices.size(); ++v) {
      add("   {}", v + 1);
      point(domain_.vertices[v]);
      add(" {}\n", label(around[v]));
      list("      ", lying_on(on_faces, in_face[around[v][0]], around[v]));
    }
  }

  void domain_edges() {
    const auto on_faces = domain_faces_of_edges(tess_.topology);
    const auto in_face = by_face(on_faces, tess_.topology.edges.size());
    add("  *edge\n   {}\n", domain_.edges.size());
    int id = 0;
    for (const auto& e : domain_.edges) {
      const std::vector<int> faces(e.faces.begin(), e.faces.end());
      add("   {} 2 {} {}\n     line\n     0\n     {}\n", ++id, e.vertices[0] + 1, e.vertices[1] + 1,
          label(faces));
      list("     ", lying_on(on_faces, in_face[faces[0]], faces));
    }
  }

  void domain_faces() {
    std::map<std::array<int, 2>, int> edges;
    for (std::size_t e = 0; e < domain_.edges.size(); ++e) {
      const auto [a, b] = domain_.edges[e].vertices;
      edges[{std::min(a, b), std::max(a, b)}] = static_cast<int>(e) + 1;
    }
    add("  *face\n   {}\n", domain_.faces.size());
    for (int d = 0; d < domain_.face_count(); ++d) {
      const auto& loop = domain_.faces[d].loop;
      add("   {} {}", d + 1, loop.size());
      for (const int v : loop) add(" {}", v + 1);
      add("\n     {}", loop.size());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int from = loop[i], to = loop[(i + 1) % loop.size()];
        add(" {}", edges.at({std::min(from, to), std::max(from, to)}));
      }
      const Plane& plane = domain_.faces[d].plane;
      add("\n     plane\n     4");
      number(-plane.offset + 0.0);
      point(-plane.normal + Vec3::Zero());
      add("\n     {}\n", domain_.faces[d].name);
      list("     ", faces_on(d));
    }
  }

  const Tessellation& tess_;
  const Domain& domain_;
  const TessNotes& notes_;
  core::FileWriter out_;
  fmt::memory_buffer text_;
};

}  // namespace

void write_tess(const Tessellation& tessellation, const std::string& path, const TessNotes& notes) {
  const auto cells = static_cast<std::size_t>(tessellation.topology.cell_count());
  for (const std::size_t size : {notes.orientations.size(), notes.ids.size(),
                                 notes.seed_weights.size(), notes.groups.size()})
    if (size != 0 && size != cells)
      throw core::InternalError(fmt::format("notes on {} of {} cells", size, cells));
  TessWriter(tessellation, path, notes).write();
}

void write_tess(const Tessellation& tessellation, const std::string& path) {
  write_tess(tessellation, path, {});
}

}  // namespace polyslip::mesh
