#include "mesh/tessellation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "mesh/face_fan.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Rounding of a point put on an oblique plane, relative to the domain.
constexpr double on_plane = 1e-14;

[[noreturn]] void fail(const std::string& what) {
  throw core::InternalError("tessellation: " + what);
}

std::vector<Vec3> face_loop(const Tessellation& t, int face) {
  std::vector<Vec3> loop;
  for (const int v : t.topology.face_vertices(face)) loop.push_back(t.vertices[v]);
  return loop;
}

void check_sizes(const Tessellation& t) {
  const auto faces = t.topology.faces.size();
  if (t.vertices.size() != static_cast<std::size_t>(t.topology.vertex_count) ||
      t.seeds.size() != t.topology.cell_faces.size() || t.face_planes.size() != faces ||
      t.face_masters.size() != faces)
    fail(fmt::format("{} vertices of {}, {} seeds of {}, {} planes and {} master points of {}",
                     t.vertices.size(), t.topology.vertex_count, t.seeds.size(),
                     t.topology.cell_faces.size(), t.face_planes.size(), t.face_masters.size(),
                     faces));
  if (!(t.domain.volume > 0)) fail("domain without volume");
  if (t.size != t.domain.size) fail("size and domain disagree");
}

/// Exactly in a box, but for its periodic directions; in other domains but for the rounding of
/// points put on oblique planes.
bool inside(const Tessellation& t, const Vec3& x) {
  if (!x.allFinite()) return false;
  if (t.domain.is_box()) {
    bool within = true;
    for (int k = 0; k < 3; ++k)
      within = within && (t.domain.periodic[k] || (x[k] >= 0 && t.size[k] - x[k] >= 0));
    return within;
  }
  const double tolerance = on_plane * t.size.maxCoeff();
  return std::all_of(t.domain.faces.begin(), t.domain.faces.end(), [&](const DomainFace& face) {
    return face.plane.normal.dot(x) - face.plane.offset <= tolerance;
  });
}

void check_vertices(const Tessellation& t) {
  for (std::size_t i = 0; i < t.vertices.size(); ++i) {
    const Vec3& x = t.vertices[i];
    if (!inside(t, x))
      fail(fmt::format("vertex {} at ({}, {}, {}) is outside the {}", i, x.x(), x.y(), x.z(),
                       t.domain.shape));
  }
  for (const auto& e : t.topology.edges)
    if (!((t.vertices[e.vertices[0]] - t.vertices[e.vertices[1]]).norm() > 0))
      fail(fmt::format("vertices {} and {} coincide", e.vertices[0], e.vertices[1]));
}

void check_translates(const Tessellation& t) {
  for (const auto& pair : t.topology.periodic.vertices)
    if (t.vertices[pair.slave] != translated(t.vertices[pair.master], pair.shift, t.size))
      fail(fmt::format("vertex {} is no translate of vertex {}", pair.slave, pair.master));
  for (const auto& list : {t.topology.periodic.vertices, t.topology.periodic.faces})
    for (const auto& pair : list)
      for (int k = 0; k < 3; ++k)
        if (pair.shift[k] != 0 && !t.domain.periodic[k])
          fail(fmt::format("a shift along direction {}, which is not periodic", k));
}

void check_face(const Tessellation& t, int f) {
  const auto& face = t.topology.faces[f];
  const auto loop = face_loop(t, f);
  if (loop.size() < 3) fail(fmt::format("face {} has {} edges", f, loop.size()));
  const int master = t.face_masters[f];
  if (master < -1 || master >= static_cast<int>(loop.size()))
    fail(fmt::format("face {} has master point {} of {}", f, master, loop.size()));
  if (!(std::abs(t.face_planes[f].normal.norm() - 1) < 1e-12) ||
      !std::isfinite(t.face_planes[f].offset))
    fail(fmt::format("face {} has no plane", f));
  if (face.domain_face >= 0) {
    const auto& [name, plane, corners] = t.domain.faces[face.domain_face];
    const bool exact = plane.normal.cwiseAbs().maxCoeff() == 1;
    const double tolerance = exact ? 0 : on_plane * t.size.maxCoeff();
    for (const Vec3& x : loop)
      if (!(std::abs(plane.normal.dot(x) - plane.offset) <= tolerance))
        fail(fmt::format("face {} leaves the domain face {}", f, name));
  }
  if (!unfolded_in_projection(loop, master)) fail(fmt::format("face {} is folded", f));
}

}  // namespace

Vec3 box_size(const PolycrystalOptions& options) {
  if (options.grains < 1)
    throw core::InputError(fmt::format("grains = {}: must be at least 1", options.grains));
  const Vec3& d = options.domain;
  if (!d.allFinite() || !(d.minCoeff() > 0))
    throw core::InputError(
        fmt::format("domain = [{}, {}, {}]: lengths must be positive", d.x(), d.y(), d.z()));
  return d * std::cbrt(options.grains / d.prod());
}

double flatness_fault(const Tessellation& tessellation, int face) {
  return degrees_of_chord(
      fan_fault(face_loop(tessellation, face), tessellation.face_masters[face]));
}

double cell_volume(const Tessellation& tessellation, int cell) {
  const auto& t = tessellation.topology;
  // The origin of the sum lies near the cell, so that large boxes cost no digits.
  const Vec3& origin = tessellation.seeds[cell];
  double volume = 0;
  for (const int f : t.cell_faces[cell]) {
    double part = 0;
    for_each_fan_triangle(face_loop(tessellation, f), tessellation.face_masters[f],
                          [&](const Vec3& a, const Vec3& b, const Vec3& m) {
                            part += (a - origin).dot((b - origin).cross(m - origin));
                          });
    volume += t.faces[f].cells[0] == cell ? part : -part;
  }
  return volume / 6;
}

void Tessellation::check() const {
  topology.check(domain.face_count());
  check_sizes(*this);
  check_vertices(*this);
  check_translates(*this);
  for (int f = 0; f < static_cast<int>(topology.faces.size()); ++f) check_face(*this, f);
  double total = 0;
  for (int c = 0; c < topology.cell_count(); ++c) {
    const double volume = cell_volume(*this, c);
    if (!(volume > 0)) fail(fmt::format("cell {} has volume {}", c, volume));
    total += volume;
  }
  if (!(std::abs(total - domain.volume) <= 1e-11 * domain.volume))
    fail(fmt::format("cells add up to {} in a domain of {}", total, domain.volume));
}

}  // namespace polyslip::mesh
