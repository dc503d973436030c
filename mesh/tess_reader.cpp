#include "mesh/tess_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/orientation_block.hpp"
#include "mesh/text_scanner.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

class TessReader {
 public:
  explicit TessReader(const std::string& path) : in_(path, read_maybe_compressed(path)) {}

  TessellationFile read() {
    header();
    read_cells();
    read_vertices();
    read_edges();
    read_faces();
    read_polyhedra();
    skip_rest();
    orient_faces();
    place_in_box();
    give_seeds();
    choose_masters();
    finish();
    return std::move(result_);
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
    if (type != "standard") in_.fail(fmt::format("type '{}'; only standard is read", type));
  }

  void skip_block() {
    while (!in_.peek().starts_with('*')) in_.word("a heading");
  }

  void read_cells() {
    in_.expect("**cell");
    cells_ = in_.count("the number of cells");
    if (cells_ < 1) in_.fail("there are no cells");
    while (!in_.peek().starts_with("**")) {
      const std::string key(in_.word("**vertex"));
      if (key == "*seed")
        read_seeds();
      else if (key == "*ori")
        read_orientations();
      else
        skip_block();
    }
  }

  void read_seeds() {
    for (int c = 0; c < cells_; ++c) {
      expect_id(c + 1, "the id of a seed");
      result_.tessellation.seeds.push_back(point("a coordinate of a seed"));
      in_.number("the weight of a seed");
    }
  }

  void read_orientations() {
    const OrientationDescriptor descriptor = read_orientation_descriptor(in_);
    result_.orientations.emplace();
    for (int c = 0; c < cells_; ++c)
      result_.orientations->push_back(read_orientation(in_, descriptor));
  }

  void read_vertices() {
    in_.expect("**vertex");
    auto& t = result_.tessellation;
    t.topology.vertex_count = in_.count("the number of vertices");
    for (int v = 0; v < t.topology.vertex_count; ++v) {
      expect_id(v + 1, "the id of a vertex");
      t.vertices.push_back(point("a coordinate of a vertex"));
      in_.integer("the state of a vertex");
    }
  }

  void read_edges() {
    in_.expect("**edge");
    auto& t = result_.tessellation.topology;
    const int count = in_.count("the number of edges");
    for (int e = 0; e < count; ++e) {
      expect_id(e + 1, "the id of an edge");
      const int from = index(result_.tessellation.vertices.size(), "a vertex of an edge");
      const int to = index(result_.tessellation.vertices.size(), "a vertex of an edge");
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
    auto& t = result_.tessellation;
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
    const auto& all = result_.tessellation.topology.edges;
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
    auto& t = result_.tessellation.topology;
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

  /// Of the domain we need no more than its box, which the vertices give.
  void skip_rest() {
    while (in_.peek() != "***end") {
      const std::string word(in_.word("***end"));
      if (word == "**periodicity") in_.fail("the tessellation is periodic; only boxes are read");
    }
  }

  /// The normal of a face on the domain boundary must point outwards.
  void orient_faces() {
    auto& t = result_.tessellation;
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
    auto& t = result_.tessellation;
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

  void place_in_box() {
    auto& t = result_.tessellation;
    if (t.vertices.empty()) fail("there are no vertices");
    low_ = high_ = t.vertices[0];
    for (const Vec3& x : t.vertices) {
      low_ = low_.cwiseMin(x);
      high_ = high_.cwiseMax(x);
    }
    for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f)
      if (t.topology.faces[f].cells[1] < 0) put_on_box(f);
    const Vec3 size = high_ - low_;
    if (!(size.minCoeff() > 0)) fail("the box of the vertices has no volume");
    const double ratio = cells_ / size.prod();
    const double scale = std::abs(ratio - 1) < 1e-9 ? 1.0 : std::cbrt(ratio);
    if (low_ != Vec3::Zero() || scale != 1.0) move(scale);
    t.size = scale * size;
    t.domain = box_domain(t.size);
  }

  void put_on_box(int f) {
    constexpr double tolerance = 1e-6;
    auto& t = result_.tessellation;
    const auto loop = t.topology.face_vertices(f);
    for (int b = 0; b < 6; ++b) {
      const int axis = b / 2;
      const double plane = (b % 2 ? high_[axis] : low_[axis]) + 0.0;  // no -0
      const double near = tolerance * (high_ - low_).minCoeff();
      if (!std::all_of(loop.begin(), loop.end(),
                       [&](int v) { return std::abs(t.vertices[v][axis] - plane) <= near; }))
        continue;
      for (const int v : loop) t.vertices[v][axis] = plane;
      t.topology.faces[f].domain_face = b;
      return;
    }
    fail(
        fmt::format("face {} of cell {} has no cell beyond it, yet lies on no side of the "
                    "vertices' bounding box; only boxes along the axes are read",
                    f + 1, t.topology.faces[f].cells[0] + 1));
  }

  void move(double scale) {
    auto& t = result_.tessellation;
    const Vec3 size = scale * (high_ - low_);
    for (Vec3& x : t.vertices)
      for (int i = 0; i < 3; ++i) x[i] = x[i] == high_[i] ? size[i] : scale * (x[i] - low_[i]);
    for (Vec3& x : t.seeds) x = scale * (x - low_);
    for (Plane& p : t.face_planes) p.offset = scale * (p.offset - p.normal.dot(low_));
  }

  void give_seeds() {
    auto& t = result_.tessellation;
    if (!t.seeds.empty()) return;
    for (int c = 0; c < cells_; ++c) {
      Vec3 sum = Vec3::Zero();
      int n = 0;
      for (const int f : t.topology.cell_faces[c])
        for (const int v : t.topology.face_vertices(f)) {
          sum += t.vertices[v];
          ++n;
        }
      t.seeds.push_back(sum / std::max(n, 1));
    }
  }

  void choose_masters() {
    auto& t = result_.tessellation;
    for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f) {
      std::vector<Vec3> loop;
      for (const int v : t.topology.face_vertices(f)) loop.push_back(t.vertices[v]);
      if (unfolded_in_projection(loop, t.face_masters[f])) continue;
      t.face_masters[f] = best_fan(loop).master;
      if (!unfolded_in_projection(loop, t.face_masters[f]))
        fail(fmt::format("face {} of cell {} is folded", f + 1, t.topology.faces[f].cells[0] + 1));
    }
  }

  void finish() const {
    try {
      result_.tessellation.check();
    } catch (const core::InternalError& e) {
      fail(fmt::format("no valid tessellation of a box: {} (ids here from 0)", e.what()));
    }
  }

  TextScanner in_;
  TessellationFile result_;
  int cells_ = 0;
  std::vector<std::array<int, 2>> sides_;  ///< of each face: the cells its normal leaves, enters
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
};

}  // namespace

TessellationFile read_tess(const std::string& path) { return TessReader(path).read(); }

}  // namespace polyslip::mesh
