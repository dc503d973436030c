#include "results/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "mesh/shape_functions.hpp"
#include "results/canvas.hpp"
#include "results/element_values.hpp"

namespace polyslip::results {
namespace {

using core::Vec3;

/// Orthonormal axes of the picture in the sample frame.
struct View {
  Vec3 right, up, towards_eye;
  View(double azimuth_degrees, double elevation_degrees) {
    const double a = azimuth_degrees / core::degrees_per_radian;
    const double e = elevation_degrees / core::degrees_per_radian;
    right = {std::cos(a), std::sin(a), 0};
    up = {-std::sin(a) * std::sin(e), std::cos(a) * std::sin(e), std::cos(e)};
    towards_eye = right.cross(up);
  }
};

/// Parallel projection: sample frame to picture.
struct Projection {
  View view;
  double scale = 1;     ///< pixels per length
  double x = 0, y = 0;  ///< where the origin of the sample frame comes to lie

  ScreenPoint operator()(const Vec3& p) const {
    return {x + scale * p.dot(view.right), y - scale * p.dot(view.up),
            -scale * p.dot(view.towards_eye)};
  }
};

/// Extent of a mesh in the picture's axes.
struct Extent {
  double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
  Extent(const mesh::Mesh& mesh, const View& view) {
    for (const auto& node : mesh.nodes) {
      left = std::min(left, node.dot(view.right));
      right = std::max(right, node.dot(view.right));
      low = std::min(low, node.dot(view.up));
      high = std::max(high, node.dot(view.up));
    }
  }
  double width() const { return right - left; }
  double height() const { return high - low; }
};

/// The element behind each triangle on the domain boundary; -1 for triangles inside.
std::vector<int> elements_behind(const mesh::Mesh& mesh) {
  std::map<std::array<int, 3>, std::size_t> triangle_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.topology.faces[mesh.triangle_face[t]].cells[1] >= 0) continue;  // inside
    std::array<int, 3> corners{mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]};
    std::sort(corners.begin(), corners.end());
    triangle_of[corners] = t;
  }
  std::vector<int> behind(mesh.triangles.size(), -1);
  for (int e = 0; e < mesh.element_count(); ++e)
    for (int left_out = 0; left_out < 4; ++left_out) {
      std::array<int, 3> corners{};
      for (int i = 0, n = 0; i < 4; ++i)
        if (i != left_out) corners[n++] = mesh.tetrahedra[e][i];
      std::sort(corners.begin(), corners.end());
      if (const auto found = triangle_of.find(corners); found != triangle_of.end())
        behind[found->second] = e;
    }
  return behind;
}

/// Positions of a triangle's six nodes; mid points where a mesh of order 1 has no mid nodes.
std::array<Vec3, 6> triangle_nodes(const mesh::Mesh& mesh, std::size_t triangle) {
  const auto& nodes = mesh.triangles[triangle];
  std::array<Vec3, 6> x;
  for (int i = 0; i < 3; ++i) x[i] = mesh.nodes[nodes[i]];
  for (int i = 0; i < 3; ++i)
    x[3 + i] = nodes[3 + i] >= 0 ? mesh.nodes[nodes[3 + i]] : 0.5 * (x[i] + x[(i + 1) % 3]);
  return x;
}

Rgb shaded(const Vec3& colour, const Vec3& normal, const View& view) {
  const Vec3 light = (view.towards_eye + 0.9 * view.up - 0.5 * view.right).normalized();
  const double factor = 0.72 + 0.28 * std::max(0.0, normal.dot(light));
  return {factor * colour[0], factor * colour[1], factor * colour[2]};
}

/// A curved triangle as small flat ones.
void fill_triangle(Canvas& canvas, const Projection& projection, const std::array<Vec3, 6>& x,
                   const Vec3& colour) {
  constexpr int n = 4;
  const auto at = [&](int i, int j) {
    const auto shape = mesh::tri6_shape(static_cast<double>(i) / n, static_cast<double>(j) / n);
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 6; ++k) p += shape[k] * x[k];
    return p;
  };
  const auto fill = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(projection.view.towards_eye) > 0)
      canvas.fill({projection(a), projection(b), projection(c)},
                  shaded(colour, normal, projection.view));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      fill(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + j + 2 <= n) fill(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
}

/// A quadratic line as short straight ones.
void draw_curve(Canvas& canvas, const Projection& projection, const Vec3& a, const Vec3& b,
                const Vec3& middle, double width, Stroke stroke) {
  constexpr int n = 4;
  ScreenPoint last = projection(a);
  for (int i = 1; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    const ScreenPoint next =
        projection((1 - t) * (1 - 2 * t) * a + t * (2 * t - 1) * b + 4 * t * (1 - t) * middle);
    canvas.line(last, next, width, stroke);
    last = next;
  }
}

void draw_boundaries(Canvas& canvas, const Projection& projection, const mesh::Mesh& mesh,
                     double width) {
  // Not where two facets of one grain and one surface meet: a cylinder's sides, say.
  std::set<int> outer;
  std::set<std::array<int, 3>> sides;  // edge, grain, surface
  const auto surfaces = mesh.domain.surface_of_face();
  for (int f = 0; f < static_cast<int>(mesh.topology.faces.size()); ++f) {
    const auto& face = mesh.topology.faces[f];
    if (face.cells[1] >= 0) continue;
    const int surface = face.domain_face >= 0 ? surfaces[face.domain_face] : -1 - f;  // periodic
    for (const int e : face.edges)
      if (!sides.insert({e, face.cells[0], surface}).second)
        outer.erase(e);
      else
        outer.insert(e);
  }
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    if (!outer.contains(mesh.line_edge[l])) continue;
    const Vec3 &a = mesh.nodes[mesh.lines[l][0]], &b = mesh.nodes[mesh.lines[l][1]];
    const int mid = mesh.lines[l][2];
    draw_curve(canvas, projection, a, b, mid >= 0 ? mesh.nodes[mid] : Vec3(0.5 * (a + b)), width,
               Stroke::grain_boundary);
  }
}

template <class Orientation>
void draw_polycrystal(Canvas& canvas, const Projection& projection, const mesh::Mesh& mesh,
                      const Orientation& orientation) {
  const auto behind = elements_behind(mesh);
  std::vector<std::size_t> shown;
  for (std::size_t t = 0; t < behind.size(); ++t)
    if (behind[t] >= 0) shown.push_back(t);
  if (shown.empty()) throw core::InternalError("results/picture: mesh without boundary triangles");
  for (const auto t : shown) {
    const core::Quaternion q = orientation(behind[t]);
    const Vec3 colour = q.coeffs().allFinite() ? core::paper_colour(q) : Vec3(Vec3::Constant(160));
    fill_triangle(canvas, projection, triangle_nodes(mesh, t), colour);
  }
  for (const auto t : shown) {
    const auto x = triangle_nodes(mesh, t);
    for (int i = 0; i < 3; ++i)
      draw_curve(canvas, projection, x[i], x[(i + 1) % 3], x[3 + i], 0.9, Stroke::element_edge);
  }
  draw_boundaries(canvas, projection, mesh, 2.4);
}

/// Arrows along x, y, z with the names of the rolling geometry.
void draw_axes(Canvas& canvas, const View& view, double x, double y, double length) {
  const Projection at{view, length, x, y};
  const std::array<std::pair<Vec3, const char*>, 3> axes{
      {{Vec3::UnitX(), "RD"}, {Vec3::UnitY(), "TD"}, {Vec3::UnitZ(), "ND"}}};
  const double height = 0.2 * length;
  for (const auto& [axis, name] : axes) {
    const ScreenPoint from = at(Vec3::Zero()), to = at(axis);
    canvas.line(from, to, 2.2, Stroke::ink);
    const Vec3 along = Vec3(to[0] - from[0], to[1] - from[1], 0).normalized();
    const Vec3 across(-along[1], along[0], 0);
    const double head = 0.1 * length;
    for (const double side : {-0.45, 0.45})
      canvas.line(to, to - head * along + side * head * across, 2.2, Stroke::ink);
    const Vec3 centre = to + (0.2 + 0.12 * std::abs(along[0])) * length * along;
    canvas.text({centre[0] - 0.5 * text_width(name, height), centre[1] + 0.5 * height, 0}, name,
                height);
  }
}

}  // namespace

void write_picture(const std::string& path, const mesh::Snapshot& undeformed,
                   const mesh::Snapshot& deformed, const PictureOptions& options) {
  const View view(options.azimuth, options.elevation);
  const std::array<const mesh::Snapshot*, 2> states{&undeformed, &deformed};
  const std::array<Extent, 2> extents{Extent(undeformed.mesh, view), Extent(deformed.mesh, view)};
  const double margin = 0.03 * options.width, letter = 0.016 * options.width;
  const double scale = (options.width - 3 * margin) / (extents[0].width() + extents[1].width());
  if (!std::isfinite(scale) || scale <= 0)
    throw core::InternalError(fmt::format("results/picture: scale {}", scale));
  const double tallest = scale * std::max(extents[0].height(), extents[1].height());
  const double axes = 0.05 * options.width;
  const double base = margin + tallest;  // of both bodies
  const double foot = base + 1.85 * axes;
  Canvas canvas(options.width, static_cast<int>(std::ceil(foot)));
  double left = margin;
  for (int i = 0; i < 2; ++i) {
    const Projection projection{view, scale, left - scale * extents[i].left,
                                base + scale * extents[i].low};
    const auto orientations = element_values(*states[i], ElementValue::average).orientation;
    draw_polycrystal(canvas, projection, states[i]->mesh,
                     [&](int element) { return orientations[element]; });
    const std::string label = fmt::format("e = {:.3g}", states[i]->strain);
    const double centre = left + 0.5 * scale * extents[i].width();
    canvas.text({centre - 0.5 * text_width(label, letter), base + 2.2 * letter, 0}, label, letter);
    left += scale * extents[i].width() + margin;
  }
  draw_axes(canvas, view, margin + 0.35 * axes, foot - 0.5 * axes, axes);
  canvas.write_png(path);
}

void write_mesh_picture(const std::string& path, const mesh::Mesh& mesh,
                        std::span<const core::Quaternion> orientations,
                        const PictureOptions& options) {
  const View view(options.azimuth, options.elevation);
  const Extent extent(mesh, view);
  const double margin = 0.03 * options.width;
  const double scale = (options.width - 2 * margin) / std::max(extent.width(), extent.height());
  if (!std::isfinite(scale) || scale <= 0)
    throw core::InternalError(fmt::format("results/picture: scale {}", scale));
  const double height = scale * extent.height();
  Canvas canvas(static_cast<int>(std::ceil(scale * extent.width() + 2 * margin)),
                static_cast<int>(std::ceil(height + 2 * margin)));
  draw_polycrystal(
      canvas,
      Projection{view, scale, margin - scale * extent.left, margin + height + scale * extent.low},
      mesh, [&](int element) { return orientations[mesh.tetrahedron_cell[element]]; });
  canvas.write_png(path);
}

}  // namespace polyslip::results
