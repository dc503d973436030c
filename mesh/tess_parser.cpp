// Neper's .tess format, version 3.5, as its reference manual describes it: ids from 1; a face of a
// polyhedron is negative if its normal points into the polyhedron, an edge of a face if the loop
// runs against it.

#include "mesh/tess_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "mesh/orientation_block.hpp"
#include "mesh/text_scanner.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

class TessParser {
 public:
  explicit TessParser(const std::string& path) : in_(path, read_maybe_compressed(path)) {}

  TessContent parse() {
    header();
    read_cells();
    read_vertices();
    read_edges();
    read_faces();
    read_polyhedra();
    read_rest();
    orient_faces();
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError(in_.path() + ": " + what);
  }

  Vec3 point(const char* what) {
    Vec3 x;
    for (int i = 0; i < 3; ++i) x[i] = in_.number(what);
    return x;
  }

  void expect_id(int expected, const char* what) {
    const int id = in_.integer(what);
    if (id != expected)
      in_.fail(
          fmt::format("{} is {} where {} should be: ids must be 1, 2, ...", what, id, expected));
  }

  /// A 0-based index of one of `count` things, from a 1-based id.
  int index(std::size_t count, const char* what) {
    const int id = in_.integer(what);
    if (id < 1 || static_cast<std::size_t>(id) > count)
      in_.fail(fmt::format("{} is {}, not one of 1 ... {}", what, id, count));
    return id - 1;
  }

  /// The same of an id with a sign.
  std::pair<int, bool> signed_index(std::size_t count, const char* what) {
    const int id = in_.integer(what);
    const long long size = std::abs(static_cast<long long>(id));
    if (size < 1 || size > static_cast<long long>(count))
      in_.fail(fmt::format("{} is {}, not one of 1 ... {}, of either sign", what, id, count));
    return {static_cast<int>(size) - 1, id > 0};
  }

  void header() {
    in_.expect("***tess");
    in_.expect("**format");
    const std::string version(in_.word("the version"));
    if (version.empty() || version[0] < '3' || version[0] > '9')
      in_.fail(fmt::format("version '{}' of the format; 3 and later are read", version));
    in_.expect("**general");
    const int dimension = in_.integer("the dimension");
    if (dimension != 3) in_.fail(fmt::format("dimension {}; only 3 is read", dimension));
    const std::string type(in_.word("the type of the tessellation"));
    if (type != "standard" && type != "periodic")
      in_.fail(fmt::format("type '{}'; standard and periodic are read", type));
  }

  void skip_block() {
    while (!in_.peek().starts_with('*')) in_.word("a heading");
  }

  void read_cells() {
    in_.expect("**cell");
    cells_ = in_.count("the number of cells");
    if (cells_ < 1) in_.fail("there are no cells");
    for (int c = 0; c < cells_; ++c) file_.cell_ids.push_back(c + 1);
    while (!in_.peek().starts_with("**")) {
      const std::string key(in_.word("**vertex"));
      if (key == "*id")
        read_ids();
      else if (key == "*seed")
        read_seeds();
      else if (key == "*ori")
        read_orientations();
      else if (key == "*crysym")
        file_.crystal = std::string(in_.word("the crystal symmetry"));
      else if (key == "*group")
        read_groups();
      else
        skip_block();
    }
  }

  void read_ids() {
    for (int& id : file_.cell_ids) {
      id = in_.integer("the id of a cell");
      if (id < 1) in_.fail(fmt::format("the id of a cell is {}, not positive", id));
    }
    auto sorted = file_.cell_ids;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) in_.fail(fmt::format("two cells have the id {}", *twice));
  }

  void read_groups() {
    file_.groups.emplace();
    for (int c = 0; c < cells_; ++c) file_.groups->push_back(in_.integer("the group of a cell"));
  }

  void read_seeds() {
    for (int c = 0; c < cells_; ++c) {
      expect_id(c + 1, "the id of a seed");
      file_.tessellation.seeds.push_back(point("a coordinate of a seed"));
      file_.seed_weights.push_back(in_.number("the weight of a seed"));
    }
  }

  void read_orientations() {
    const OrientationDescriptor descriptor = read_orientation_descriptor(in_);
    file_.orientations.emplace();
    for (int c = 0; c < cells_; ++c)
      file_.orientations->push_back(read_orientation(in_, descriptor));
  }

  void read_vertices() {
    in_.expect("**vertex");
    auto& t = file_.tessellation;
    t.topology.vertex_count = in_.count("the number of vertices");
    for (int v = 0; v < t.topology.vertex_count; ++v) {
      expect_id(v + 1, "the id of a vertex");
      t.vertices.push_back(point("a coordinate of a vertex"));
      in_.integer("the state of a vertex");
    }
  }

  void read_edges() {
    in_.expect("**edge");
    auto& t = file_.tessellation.topology;
    const int count = in_.count("the number of edges");
    for (int e = 0; e < count; ++e) {
      expect_id(e + 1, "the id of an edge");
      const int from = index(file_.tessellation.vertices.size(), "a vertex of an edge");
      const int to = index(file_.tessellation.vertices.size(), "a vertex of an edge");
      t.edges.push_back({{from, to}});
      in_.integer("the state of an edge");
    }
  }

  void read_faces() {
    in_.expect("**face");
    const int count = in_.count("the number of faces");
    for (int f = 0; f < count; ++f) {
      expect_id(f + 1, "the id of a face");
      read_face(f);
    }
  }

  void read_face(int f) {
    auto& t = file_.tessellation;
    const int n = in_.count("the number of vertices of a face");
    if (n < 3) in_.fail(fmt::format("face {} has {} vertices", f + 1, n));
    std::vector<int> loop;
    for (int i = 0; i < n; ++i) loop.push_back(index(t.vertices.size(), "a vertex of a face"));
    const int m = in_.integer("the number of edges of a face");
    if (m != n) in_.fail(fmt::format("face {} has {} vertices and {} edges", f + 1, n, m));
    t.topology.faces.push_back(read_loop(f, loop));
    t.face_planes.push_back(read_plane(f));
    in_.integer("the state of a face");
    const int master = in_.integer("the point of a face");
    if (master > n)
      in_.fail(fmt::format("the point of face {} is vertex {} of {}", f + 1, master, n));
    t.face_masters.push_back(master >= 1 ? master - 1 : -1);
    point("a coordinate of the point of a face");
  }

  /// Edges of a face, turned so that edge i starts at vertex i: in files their list may begin with
  /// another edge than that of the first vertex.
  TopologyFace read_loop(int f, const std::vector<int>& loop) {
    const auto& all = file_.tessellation.topology.edges;
    const std::size_t n = loop.size();
    TopologyFace face;
    std::size_t first = n;
    for (std::size_t i = 0; i < n; ++i) {
      const auto [edge, forward] = signed_index(all.size(), "an edge of a face");
      face.edges.push_back(edge);
      face.forward.push_back(forward);
      if (all[edge].vertices[forward ? 0 : 1] == loop[0]) first = i;
    }
    const auto turn = static_cast<std::ptrdiff_t>(first % n);
    std::rotate(face.edges.begin(), face.edges.begin() + turn, face.edges.end());
    std::rotate(face.forward.begin(), face.forward.begin() + turn, face.forward.end());
    for (std::size_t i = 0; i < n; ++i) {
      const auto& ends = all[face.edges[i]].vertices;
      const int from = face.forward[i] ? 0 : 1;
      if (ends[from] != loop[i] || ends[1 - from] != loop[(i + 1) % n])
        in_.fail(fmt::format("edge {} of face {} does not join its vertices {} and {}",
                             face.edges[i] + 1, f + 1, loop[i] + 1, loop[(i + 1) % n] + 1));
    }
    return face;
  }

  Plane read_plane(int f) {
    Plane plane;
    plane.offset = in_.number("the offset of a face's plane");
    plane.normal = point("a component of a face's normal");
    const double length = plane.normal.norm();
    if (!(std::abs(length - 1) < 1e-3))
      in_.fail(fmt::format("the normal of face {} has length {}, not 1", f + 1, length));
    if (std::abs(length - 1) > 1e-14) {
      plane.normal /= length;
      plane.offset /= length;
    }
    return plane;
  }

  void read_polyhedra() {
    in_.expect("**polyhedron");
    auto& t = file_.tessellation.topology;
    const int count = in_.count("the number of polyhedra");
    if (count != cells_) in_.fail(fmt::format("{} polyhedra of {} cells", count, cells_));
    sides_.assign(t.faces.size(), {-1, -1});
    for (int c = 0; c < count; ++c) {
      expect_id(c + 1, "the id of a polyhedron");
      const int n = in_.count("the number of faces of a polyhedron");
      t.cell_faces.emplace_back();
      for (int i = 0; i < n; ++i) {
        const auto [face, outward] = signed_index(t.faces.size(), "a face of a polyhedron");
        t.cell_faces.back().push_back(face);
        int& side = sides_[face][outward ? 0 : 1];
        if (side >= 0)
          in_.fail(fmt::format("face {} has polyhedra {} and {} on the same side", face + 1,
                               side + 1, c + 1));
        side = c;
      }
    }
  }

  void read_rest() {
    while (in_.peek() != "***end") {
      const std::string word(in_.word("***end"));
      if (word == "**domain") read_domain();
      if (word == "**periodicity" || word == "**periodic") read_periodicity();
    }
  }

  void read_periodicity() {
    TessContent::Translates p;
    in_.expect("*general");
    for (bool& on : p.directions) {
      const int flag = in_.integer("whether a direction is periodic");
      if (flag != 0 && flag != 1)
        in_.fail(fmt::format("a direction's periodicity is {}, neither 0 nor 1", flag));
      on = flag == 1;
    }
    p.distances = point("a periodic distance");
    const auto& t = file_.tessellation.topology;
    while (!in_.peek().starts_with("**") && !in_.peek().empty()) {
      const std::string key(in_.word("a heading"));
      if (key == "*vertex")
        p.vertices = read_translates(p, static_cast<std::size_t>(t.vertex_count), false);
      else if (key == "*edge")
        p.edges = read_translates(p, t.edges.size(), true);
      else if (key == "*face")
        p.faces = read_translates(p, t.faces.size(), true);
      else
        skip_block();
    }
    if (p.directions != std::array<bool, 3>{false, false, false}) content_.periodic = std::move(p);
  }

  std::vector<TessContent::Translate> read_translates(const TessContent::Translates& p,
                                                      std::size_t things, bool oriented) {
    std::vector<TessContent::Translate> rows;
    for (int n = in_.count("the number of secondaries"); n > 0; --n) {
      TessContent::Translate row;
      row.secondary = index(things, "a secondary");
      row.primary = index(things, "a primary");
      for (int k = 0; k < 3; ++k) {
        row.shift[k] = in_.integer("a periodic shift");
        if (row.shift[k] != 0 && !p.directions[k])
          in_.fail(fmt::format("shift {} along a direction that is not periodic", row.shift[k]));
      }
      if (oriented) row.orientation = in_.integer("the orientation of a secondary");
      if (row.orientation != 1 && row.orientation != -1)
        in_.fail(fmt::format("an orientation is {}, neither 1 nor -1", row.orientation));
      rows.push_back(row);
    }
    return rows;
  }

  /// Of the domain we need its faces.
  void read_domain() {
    in_.expect("*general");
    content_.domain_type = std::string(in_.word("the type of the domain"));
    while (in_.peek() != "*face") {
      if (in_.peek().starts_with("**")) return;
      in_.word("*face of **domain");
    }
    in_.expect("*face");
    const int count = in_.count("the number of domain faces");
    for (int d = 0; d < count; ++d) {
      expect_id(d + 1, "the id of a domain face");
      read_domain_face();
    }
  }

  void read_domain_face() {
    TessContent::DomainFace face;
    for (const char* what :
         {"the number of vertices of a domain face", "the number of edges of a domain face"})
      for (int n = in_.count(what); n > 0; --n) in_.integer("a vertex or an edge of a domain face");
    face.type = std::string(in_.word("the type of a domain face"));
    std::vector<double> parameters;
    for (int n = in_.count("the number of parameters of a domain face"); n > 0; --n)
      parameters.push_back(in_.number("a parameter of a domain face"));
    if (face.type == "plane") {
      if (parameters.size() != 4)
        in_.fail(fmt::format("a plane of {} parameters, not 4", parameters.size()));
      face.plane = {Vec3(parameters[1], parameters[2], parameters[3]), parameters[0]};
      if (!(face.plane.normal.norm() > 0)) in_.fail("a plane without a normal");
    }
    face.name = std::string(in_.word("the label of a domain face"));
    for (int n = in_.count("the number of faces in a domain face"); n > 0; --n)
      face.faces.push_back(
          index(file_.tessellation.topology.faces.size(), "a face in a domain face"));
    content_.domain_faces.push_back(std::move(face));
  }

  /// The normal of a face on the domain boundary must point outwards.
  void orient_faces() {
    auto& t = file_.tessellation;
    for (std::size_t f = 0; f < sides_.size(); ++f) {
      auto [inside, outside] = sides_[f];
      if (inside < 0 && outside < 0) fail(fmt::format("face {} is of no polyhedron", f + 1));
      if (inside < 0) {
        std::swap(inside, outside);
        reverse(static_cast<int>(f));
      }
      t.topology.faces[f].cells = {inside, outside};
    }
  }

  void reverse(int f) {
    auto& t = file_.tessellation;
    auto& face = t.topology.faces[f];
    std::reverse(face.edges.begin(), face.edges.end());
    std::reverse(face.forward.begin(), face.forward.end());
    face.forward.flip();
    // The loop v0 v1 ... v(n-1) becomes v0 v(n-1) ... v1.
    const int n = static_cast<int>(face.edges.size());
    if (t.face_masters[f] > 0) t.face_masters[f] = n - t.face_masters[f];
    t.face_planes[f].normal = -t.face_planes[f].normal;
    t.face_planes[f].offset = -t.face_planes[f].offset;
  }

  TextScanner in_;
  TessContent content_;
  TessellationFile& file_ = content_.file;
  int cells_ = 0;
  std::vector<std::array<int, 2>> sides_;  ///< of each face: the cells its normal leaves, enters
};

}  // namespace

TessContent parse_tess(const std::string& path) { return TessParser(path).parse(); }

}  // namespace polyslip::mesh
