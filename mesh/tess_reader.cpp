#include "mesh/tess_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "mesh/face_fan.hpp"
#include "mesh/tess_parser.hpp"
#include "mesh/tess_translates.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Files have about twelve digits: what is this near, of the domain's smallest side, is one.
constexpr double tolerance = 1e-6;

/// Puts a tessellation into its domain.
class Placement {
 public:
  Placement(const std::string& path, LengthUnit unit)
      : path_(path), unit_(unit), content_(parse_tess(path)) {}

  TessellationFile take() {
    if (t_.vertices.empty()) fail("there are no vertices");
    measure();
    if (content_.periodic)
      place_in_periodic_box();
    else if (!place_in_box())
      place_in_polyhedron();
    give_seeds();
    choose_masters();
    try {
      t_.check();
    } catch (const core::InternalError& e) {
      fail(fmt::format("no valid tessellation of its domain: {} (ids here from 0)", e.what()));
    }
    return std::move(content_.file);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError(path_ + ": " + what);
  }

  int face_count() const { return static_cast<int>(t_.topology.faces.size()); }
  bool outside(int f) const { return t_.topology.faces[f].cells[1] < 0; }
  double near() const { return tolerance * (high_ - low_).minCoeff(); }

  void measure() {
    low_ = high_ = t_.vertices[0];
    for (const Vec3& x : t_.vertices) {
      low_ = low_.cwiseMin(x);
      high_ = high_.cwiseMax(x);
    }
    if (!((high_ - low_).minCoeff() > 0)) fail("the box of the vertices has no volume");
  }

  double scale_for(double volume) const {
    const double ratio = t_.topology.cell_count() / volume;
    return unit_ == LengthUnit::file || std::abs(ratio - 1) < 1e-9 ? 1.0 : std::cbrt(ratio);
  }

  /// The side of the bounding box that a face lies on, or -1.
  int side_of(int f) const {
    const auto loop = t_.topology.face_vertices(f);
    for (int b = 0; b < 6; ++b) {
      const double plane = (b % 2 ? high_ : low_)[b / 2];
      if (std::all_of(loop.begin(), loop.end(),
                      [&](int v) { return std::abs(t_.vertices[v][b / 2] - plane) <= near(); }))
        return b;
    }
    return -1;
  }

  /// Cells stick out of the box along its periodic directions, so **domain has to tell it.
  void place_in_periodic_box() {
    const auto& periodic = *content_.periodic;
    std::array<bool, 6> told{};
    for (const auto& d : content_.domain_faces)
      for (int axis = 0; axis < 3 && d.type == "plane"; ++axis) {
        const Plane plane = outward(d.plane);
        const double along = plane.normal[axis];
        if (std::abs(std::abs(along) - 1) > tolerance) continue;
        (along > 0 ? high_ : low_)[axis] = plane.offset / along;
        told[2 * axis + (along > 0 ? 1 : 0)] = true;
      }
    if (std::find(told.begin(), told.end(), false) != told.end())
      fail("the tessellation is periodic, but **domain is not a box along the axes");
    for (int k = 0; k < 3; ++k)
      if (periodic.directions[k] &&
          !(std::abs(high_[k] - low_[k] - periodic.distances[k]) <= near()))
        fail(fmt::format("the periodic distance along {} is {}, the domain has {}", "xyz"[k],
                         periodic.distances[k], high_[k] - low_[k]));
    const std::vector<char> paired = faces_of_pairs(periodic);
    for (int f = 0; f < face_count(); ++f)
      if (outside(f) && !paired[f]) put_on_side(f);
    const Vec3 size = high_ - low_;
    move(scale_for(size.prod()));
    t_.domain = box_domain(content_.file.scale * size);
    t_.domain.periodic = periodic.directions;
    t_.size = t_.domain.size;
    const std::string fault = join_translates(periodic, tolerance * t_.size.minCoeff(), t_);
    if (!fault.empty()) fail(fault);
  }

  std::vector<char> faces_of_pairs(const TessContent::Translates& periodic) const {
    std::vector<char> paired(face_count(), false);
    for (const auto& row : periodic.faces) paired[row.secondary] = paired[row.primary] = true;
    return paired;
  }

  void put_on_side(int f) {
    const int side = side_of(f);
    if (side < 0 || content_.periodic->directions[side / 2])
      fail(
          fmt::format("face {} of cell {} has no cell beyond it, yet is in no periodic pair and on "
                      "no side of the domain",
                      f + 1, t_.topology.faces[f].cells[0] + 1));
    t_.topology.faces[f].domain_face = side;
    for (const int v : t_.topology.face_vertices(f))
      t_.vertices[v][side / 2] = (side % 2 ? high_ : low_)[side / 2] + 0.0;
  }

  /// False, with nothing done, if a face on the surface is on no side of the bounding box.
  bool place_in_box() {
    std::vector<int> sides(face_count(), -1);
    for (int f = 0; f < face_count(); ++f)
      if (outside(f) && (sides[f] = side_of(f)) < 0) return false;
    for (int f = 0; f < face_count(); ++f) {
      t_.topology.faces[f].domain_face = sides[f];
      if (sides[f] < 0) continue;
      const int axis = sides[f] / 2;
      const double plane = (sides[f] % 2 ? high_ : low_)[axis] + 0.0;  // no -0
      for (const int v : t_.topology.face_vertices(f)) t_.vertices[v][axis] = plane;
    }
    const Vec3 size = high_ - low_;
    move(scale_for(size.prod()));
    t_.domain = box_domain(content_.file.scale * size);
    t_.size = t_.domain.size;
    return true;
  }

  void move(double scale) {
    content_.file.origin = low_;
    content_.file.scale = scale;
    if (low_ == Vec3::Zero() && scale == 1.0) return;
    const Vec3 size = scale * (high_ - low_);
    for (Vec3& x : t_.vertices)
      for (int i = 0; i < 3; ++i) x[i] = x[i] == high_[i] ? size[i] : scale * (x[i] - low_[i]);
    for (Vec3& x : t_.seeds) x = scale * (x - low_);
    for (Plane& p : t_.face_planes) p.offset = scale * (p.offset - p.normal.dot(low_));
  }

  /// Planes of the domain, outwards, their names, and for each face of the tessellation its plane.
  struct Walls {
    std::vector<Plane> planes;
    std::vector<std::string> names;
    std::vector<int> of_face;
  };

  /// How far the vertices of a face are from a plane, at most.
  double distance(int f, const Plane& plane) const {
    double most = 0;
    for (const int v : t_.topology.face_vertices(f))
      most = std::max(most, std::abs(plane.normal.dot(t_.vertices[v]) - plane.offset));
    return most;
  }

  Plane outward(Plane plane) const {
    const double length = plane.normal.norm();
    const Vec3 middle = (low_ + high_) / 2;
    const double sign = plane.normal.dot(middle) > plane.offset ? -1 : 1;
    return {sign / length * plane.normal, sign / length * plane.offset};
  }

  /// A curved face of the domain is a facet for each plane that its faces have.
  int facet_of(int f, const std::string& name, std::size_t first, Walls& walls) const {
    for (std::size_t i = first; i < walls.planes.size(); ++i)
      if (distance(f, walls.planes[i]) <= near() &&
          walls.planes[i].normal.dot(t_.face_planes[f].normal) > 1 - tolerance)
        return static_cast<int>(i);
    walls.planes.push_back(outward(t_.face_planes[f]));
    walls.names.push_back(name);
    return static_cast<int>(walls.planes.size()) - 1;
  }

  Walls walls() const {
    Walls w;
    w.of_face.assign(face_count(), -1);
    for (const auto& d : content_.domain_faces) {
      const std::size_t first = w.planes.size();
      if (d.type == "plane" && !d.faces.empty()) {
        w.planes.push_back(outward(d.plane));
        w.names.push_back(d.name);
      }
      for (const int f : d.faces) {
        const int wall =
            d.type == "plane" ? static_cast<int>(first) : facet_of(f, d.name, first, w);
        if (!(distance(f, w.planes[wall]) <= near()))
          fail(fmt::format("face {} is {:.3g} off the face {} of the domain", f + 1,
                           distance(f, w.planes[wall]), d.name));
        w.of_face[f] = wall;
      }
    }
    for (int f = 0; f < face_count(); ++f)
      if (outside(f) && w.of_face[f] < 0)
        fail(
            fmt::format("face {} of cell {} has no cell beyond it, yet lies neither on a side of "
                        "the vertices' bounding box nor in a face of **domain",
                        f + 1, t_.topology.faces[f].cells[0] + 1));
    return w;
  }

  void place_in_polyhedron() {
    const Walls w = walls();
    // Ours has names of its own for a box, which has been tried.
    const std::string type = content_.domain_type;
    const std::string shape = type == "cylinder" || type == "sphere" ? type : "polyhedron";
    try {
      t_.domain = convex_domain(shape, w.planes, w.names);
      const double scale = scale_for(t_.domain.volume);
      if (scale != 1) t_.domain = convex_domain(shape, w.planes, w.names, t_.topology.cell_count());
      move(scale);
    } catch (const core::InputError& e) {
      fail(fmt::format("the faces of **domain are those of no convex body: {}", e.what()));
    }
    t_.size = t_.domain.size;
    for (int f = 0; f < face_count(); ++f)
      t_.topology.faces[f].domain_face = outside(f) ? w.of_face[f] : -1;
    const DomainFaceLists on = domain_faces_of_vertices(t_.topology);
    for (std::size_t v = 0; v < t_.vertices.size(); ++v) {
      std::vector<Plane> planes;
      for (const int d : on[v]) planes.push_back(t_.domain.faces[d].plane);
      put_on_planes(planes, t_.vertices[v]);
      // Where planes meet obliquely, rounding may lead beyond the bounding box.
      t_.vertices[v] = t_.vertices[v].cwiseMax(0.0).cwiseMin(t_.size);
    }
  }

  void give_seeds() {
    if (!t_.seeds.empty()) return;
    for (int c = 0; c < t_.topology.cell_count(); ++c) {
      Vec3 sum = Vec3::Zero();
      int n = 0;
      for (const int f : t_.topology.cell_faces[c])
        for (const int v : t_.topology.face_vertices(f)) {
          sum += t_.vertices[v];
          ++n;
        }
      t_.seeds.push_back(sum / std::max(n, 1));
    }
  }

  void choose_masters() {
    for (int f = 0; f < face_count(); ++f) {
      std::vector<Vec3> loop;
      for (const int v : t_.topology.face_vertices(f)) loop.push_back(t_.vertices[v]);
      if (unfolded_in_projection(loop, t_.face_masters[f])) continue;
      t_.face_masters[f] = best_fan(loop).master;
      if (!unfolded_in_projection(loop, t_.face_masters[f]))
        fail(fmt::format("face {} of cell {} is folded", f + 1, t_.topology.faces[f].cells[0] + 1));
    }
  }

  std::string path_;
  LengthUnit unit_;
  TessContent content_;
  Tessellation& t_ = content_.file.tessellation;
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
};

}  // namespace

TessellationFile read_tess(const std::string& path, LengthUnit unit) {
  return Placement(path, unit).take();
}

}  // namespace polyslip::mesh
