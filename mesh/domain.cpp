#include "mesh/domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "mesh/topology.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Normals closer than this (sine) are one; points closer than this, of the domain's extent, too.
constexpr double same_direction = 1e-7, same_point = 1e-9;

int axis_of(const Vec3& normal) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(normal[i]) == 1) return i;
  return -1;
}

/// A side of a facet in the making: from `point`, along the cut by plane `cut` (-1: none yet).
struct Corner {
  Vec3 point;
  int cut = -1;
};

/// The facet of plane i that the other planes leave.
class FacetCutter {
 public:
  FacetCutter(const std::vector<Plane>& planes, double extent) : planes_(planes), extent_(extent) {}

  std::vector<Corner> facet(int i) const {
    auto corners = square(planes_[i]);
    for (int j = 0; j < static_cast<int>(planes_.size()) && !corners.empty(); ++j)
      if (j != i) cut(corners, j);
    return corners;
  }

 private:
  std::vector<Corner> square(const Plane& plane) const {
    const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
    const Vec3 centre = plane.offset * plane.normal;
    return {{centre - extent_ * (u + v)},
            {centre + extent_ * (u - v)},
            {centre + extent_ * (u + v)},
            {centre - extent_ * (u - v)}};
  }

  void cut(std::vector<Corner>& corners, int j) const {
    const auto height = [&](const Corner& c) {
      return planes_[j].normal.dot(c.point) - planes_[j].offset;
    };
    const std::size_t n = corners.size();
    if (std::all_of(corners.begin(), corners.end(),
                    [&](const Corner& c) { return height(c) <= 0; }))
      return;
    std::vector<Corner> kept;
    for (std::size_t k = 0; k < n; ++k) {
      const Corner &a = corners[k], &b = corners[(k + 1) % n];
      const double ha = height(a), hb = height(b);
      if (ha <= 0) kept.push_back(a);
      if ((ha <= 0) == (hb <= 0)) continue;
      const Vec3 x = a.point + ha / (ha - hb) * (b.point - a.point);
      kept.push_back({x, ha <= 0 ? j : a.cut});
    }
    corners = std::move(kept);
    if (corners.size() < 3) corners.clear();
  }

  const std::vector<Plane>& planes_;
  double extent_;
};

class Polyhedron {
 public:
  Polyhedron(const std::string& shape, std::vector<Plane> planes,
             const std::vector<std::string>& names)
      : planes_(std::move(planes)) {
    domain_.shape = shape;
    unit_normals();
    find_facets();
    for (int i = 0; i < count(); ++i) domain_.faces.push_back({names[i], planes_[i], {}});
    number_vertices();
    find_edges();
  }

  Domain take(double volume) {
    place(volume);
    return std::move(domain_);
  }

 private:
  int count() const { return static_cast<int>(planes_.size()); }

  std::string name(int i) const {
    const Vec3 n = planes_[i].normal + Vec3::Zero();  // no minus before zeros
    return fmt::format("half-space {} ({:.6g} x + {:.6g} y + {:.6g} z <= {:.6g})", i + 1, n.x(),
                       n.y(), n.z(), planes_[i].offset + 0.0);
  }

  void unit_normals() {
    for (int i = 0; i < count(); ++i) {
      Plane& p = planes_[i];
      const double length = p.normal.norm();
      if (!std::isfinite(length) || !std::isfinite(p.offset) || !(length > 0))
        throw core::InputError(fmt::format("{} is none: its normal must not be zero", name(i)));
      p.normal /= length;
      p.offset /= length;
      for (double& n : p.normal)
        if (std::abs(n) < 1e-15) n = 0;
      if (const int axis = axis_of(p.normal.normalized()); axis >= 0)
        p.normal = Vec3::Unit(axis) * (p.normal[axis] > 0 ? 1.0 : -1.0);
      for (int j = 0; j < i; ++j)
        if ((planes_[j].normal - p.normal).norm() < same_direction)
          throw core::InputError(
              fmt::format("{} has the direction of {}: remove the one that does not bound the body",
                          name(i), name(j)));
    }
  }

  void find_facets() {
    double offsets = 0;
    for (const Plane& p : planes_) offsets = std::max(offsets, std::abs(p.offset));
    const double extent = 1e5 * std::max(offsets, 1e-6);
    const FacetCutter cutter(planes_, extent);
    std::vector<int> empty;
    for (int i = 0; i < count(); ++i) {
      facets_.push_back(cutter.facet(i));
      if (facets_.back().empty()) empty.push_back(i);
      for (const Corner& c : facets_.back())
        if (c.cut < 0)
          throw core::InputError(fmt::format(
              "the half-spaces enclose no body: it has no end along {}; add half-spaces", name(i)));
    }
    if (static_cast<int>(empty.size()) == count() || count() < 4)
      throw core::InputError("the half-spaces enclose no body: no point lies in all of them");
    if (!empty.empty())
      throw core::InputError(
          fmt::format("{} bounds nothing: the others leave nothing of its plane; remove it",
                      name(empty.front())));
    scale_ = 0;
    for (const auto& facet : facets_)
      for (const Corner& c : facet)
        scale_ = std::max(scale_, (c.point - facets_[0][0].point).norm());
  }

  int vertex_at(const Vec3& x) {
    for (std::size_t v = 0; v < domain_.vertices.size(); ++v)
      if ((domain_.vertices[v] - x).norm() <= same_point * scale_) return static_cast<int>(v);
    domain_.vertices.push_back(x);
    return static_cast<int>(domain_.vertices.size()) - 1;
  }

  void number_vertices() {
    for (int i = 0; i < count(); ++i) {
      auto& loop = domain_.faces[i].loop;
      for (const Corner& c : facets_[i]) {
        const int v = vertex_at(c.point);
        if (loop.empty() || (loop.back() != v && loop.front() != v)) loop.push_back(v);
      }
      if (loop.size() < 3)
        throw core::InputError(
            fmt::format("{} bounds nothing but an edge or a corner; remove it", name(i)));
    }
    std::vector<std::vector<Plane>> around(domain_.vertices.size());
    for (int i = 0; i < count(); ++i)
      for (const int v : domain_.faces[i].loop) around[v].push_back(planes_[i]);
    for (std::size_t v = 0; v < around.size(); ++v) put_on_planes(around[v], domain_.vertices[v]);
  }

  void find_edges() {
    std::map<std::array<int, 2>, int> of_pair;
    for (int i = 0; i < count(); ++i) {
      const auto& loop = domain_.faces[i].loop;
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const int a = loop[k], b = loop[(k + 1) % loop.size()];
        const auto [at, added] = of_pair.try_emplace({std::min(a, b), std::max(a, b)},
                                                     static_cast<int>(domain_.edges.size()));
        if (added)
          domain_.edges.push_back({at->first, {i, -1}});
        else
          domain_.edges[at->second].faces[1] = i;
      }
    }
    for (const auto& e : domain_.edges)
      if (e.faces[1] < 0)
        throw core::InputError(
            fmt::format("{} has an edge that no other half-space bounds: half-spaces must not "
                        "nearly coincide",
                        name(e.faces[0])));
  }

  double enclosed() const {
    const Vec3& origin = domain_.vertices[0];
    double sum = 0;
    for (const auto& face : domain_.faces)
      for (std::size_t k = 1; k + 1 < face.loop.size(); ++k) {
        const auto at = [&](std::size_t j) -> Vec3 {
          return domain_.vertices[face.loop[j]] - origin;
        };
        sum += at(0).dot(at(k).cross(at(k + 1)));
      }
    return sum / 6;
  }

  void place(double volume) {
    Vec3 low = domain_.vertices[0], high = low;
    for (const Vec3& x : domain_.vertices) low = low.cwiseMin(x), high = high.cwiseMax(x);
    const double given = enclosed();
    if (!(given > 0)) throw core::InputError("the half-spaces enclose no volume");
    const double scale = volume > 0 ? std::cbrt(volume / given) : 1.0;
    domain_.origin = low;
    domain_.scale = scale;
    domain_.size = scale * (high - low);
    for (Vec3& x : domain_.vertices)
      for (int i = 0; i < 3; ++i)
        x[i] = x[i] == high[i] ? domain_.size[i] : scale * (x[i] - low[i]);
    for (auto& face : domain_.faces) {
      Plane& p = face.plane;
      const int axis = axis_of(p.normal);
      if (axis >= 0)
        p.offset = p.normal[axis] > 0 ? domain_.size[axis] : 0.0;
      else
        p.offset = scale * (p.offset - p.normal.dot(low));
    }
    domain_.volume = enclosed();
  }

  std::vector<Plane> planes_;
  std::vector<std::vector<Corner>> facets_;
  double scale_ = 0;
  Domain domain_;
};

}  // namespace

std::vector<std::string> Domain::surface_names() const {
  std::vector<std::string> names;
  for (const auto& face : faces)
    if (std::find(names.begin(), names.end(), face.name) == names.end()) names.push_back(face.name);
  return names;
}

std::vector<int> Domain::surface_of_face() const {
  const auto names = surface_names();
  std::vector<int> surfaces;
  for (const auto& face : faces)
    surfaces.push_back(
        static_cast<int>(std::find(names.begin(), names.end(), face.name) - names.begin()));
  return surfaces;
}

Domain box_domain(const Vec3& size) {
  if (!size.allFinite() || !(size.minCoeff() > 0))
    throw core::InputError(
        fmt::format("box [{}, {}, {}]: lengths must be positive", size.x(), size.y(), size.z()));
  Domain box;
  box.size = size;
  box.volume = size.prod();
  // Corner i: bits 0, 1, 2 of i say whether x, y, z are at the far side.
  for (int corner = 0; corner < 8; ++corner)
    box.vertices.emplace_back(corner & 1 ? size.x() : 0.0, corner & 2 ? size.y() : 0.0,
                              corner & 4 ? size.z() : 0.0);
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 8; ++corner) {
      if (corner >> axis & 1) continue;
      const int p = axis == 0 ? 1 : 0, q = axis == 2 ? 1 : 2;
      box.edges.push_back(
          {{corner, corner | 1 << axis}, {2 * p + (corner >> p & 1), 2 * q + (corner >> q & 1)}});
    }
  for (int b = 0; b < 6; ++b) {
    const int axis = b / 2, p = (axis + 1) % 3, q = (axis + 2) % 3, base = (b % 2) << axis;
    DomainFace face;
    face.name = box_face_names[b];
    face.plane.normal = Vec3::Unit(axis) * (b % 2 ? 1.0 : -1.0);
    face.plane.offset = b % 2 ? size[axis] : 0.0;
    face.loop = {base, base | 1 << p, base | 1 << p | 1 << q, base | 1 << q};
    if (b % 2 == 0) std::reverse(face.loop.begin() + 1, face.loop.end());
    box.faces.push_back(std::move(face));
  }
  return box;
}

Domain convex_domain(const std::string& shape, std::vector<Plane> planes,
                     const std::vector<std::string>& names, double volume) {
  return Polyhedron(shape, std::move(planes), names).take(volume);
}

Directions free_directions(std::span<const Plane> planes) {
  Directions all;  // of the normals, then the free ones
  const auto rest_of = [&](Vec3 rest) {
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < all.count; ++i) rest -= all.directions[i].dot(rest) * all.directions[i];
    return rest;
  };
  for (const Plane& p : planes) {
    if (all.count == 3) break;
    const Vec3 rest = rest_of(p.normal);
    if (rest.norm() > same_direction) all.directions[all.count++] = rest.normalized();
  }
  Directions free;
  for (int axis = 0; axis < 3 && all.count < 3; ++axis) {
    const Vec3 rest = rest_of(Vec3::Unit(axis));
    if (!(rest.norm() > 0.3)) continue;  // of three axes enough are farther from what is taken
    all.directions[all.count++] = free.directions[free.count++] = rest.normalized();
  }
  return free;
}

void put_on_planes(std::span<const Plane> planes, Vec3& x) {
  std::array<Plane, 3> order;  // those along the axes first, then what is independent of them
  std::array<Vec3, 3> directions;
  int count = 0;
  const auto take = [&](const Plane& p) {
    if (count == 3) return;
    Vec3 rest = p.normal;
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < count; ++i) rest -= directions[i].dot(rest) * directions[i];
    if (!(rest.norm() > same_direction)) return;
    order[count] = p;
    directions[count++] = rest.normalized();
  };
  for (const Plane& p : planes)
    if (axis_of(p.normal) >= 0) take(p);
  int exact = count;
  for (const Plane& p : planes)
    if (axis_of(p.normal) < 0) take(p);
  for (int i = 0; i < exact; ++i) {
    const int axis = axis_of(order[i].normal);
    x[axis] = order[i].normal[axis] * order[i].offset + 0.0;
  }
  // Each step keeps the planes before: it goes along a direction at right angles to their normals.
  for (int pass = 0; pass < 2; ++pass)
    for (int i = exact; i < count; ++i)
      x += (order[i].offset - order[i].normal.dot(x)) / order[i].normal.dot(directions[i]) *
           directions[i];
  for (int i = 0; i < exact; ++i) {
    const int axis = axis_of(order[i].normal);
    x[axis] = order[i].normal[axis] * order[i].offset + 0.0;
  }
}

DomainFaceLists::DomainFaceLists(std::size_t entities, std::vector<std::array<int, 2>> pairs)
    : starts_(entities + 1, 0) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  faces_.reserve(pairs.size());
  for (const auto& [entity, face] : pairs) {
    ++starts_[entity + 1];
    faces_.push_back(face);
  }
  for (std::size_t i = 0; i < entities; ++i) starts_[i + 1] += starts_[i];
}

DomainFaceLists domain_faces_of_vertices(const Topology& topology) {
  std::vector<std::array<int, 2>> pairs;
  for (const auto& face : topology.faces)
    if (face.domain_face >= 0)
      for (const int e : face.edges)
        for (const int v : topology.edges[e].vertices) pairs.push_back({v, face.domain_face});
  return {static_cast<std::size_t>(topology.vertex_count), std::move(pairs)};
}

DomainFaceLists domain_faces_of_edges(const Topology& topology) {
  std::vector<std::array<int, 2>> pairs;
  for (const auto& face : topology.faces)
    if (face.domain_face >= 0)
      for (const int e : face.edges) pairs.push_back({e, face.domain_face});
  return {topology.edges.size(), std::move(pairs)};
}

}  // namespace polyslip::mesh
