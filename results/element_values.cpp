#include "results/element_values.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::results {
namespace {

using core::Vec3;
using mesh::Location;

constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// Positions of the ten nodes; mid nodes that a mesh of order 1 lacks lie at mid points.
std::array<Vec3, 10> element_nodes(const mesh::Mesh& mesh, int element) {
  std::array<Vec3, 10> x;
  const auto& nodes = mesh.tetrahedra[element];
  for (int i = 0; i < 4; ++i) x[i] = mesh.nodes[nodes[i]];
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = mesh::tetrahedron_edges[e];
    x[4 + e] = nodes[4 + e] >= 0 ? mesh.nodes[nodes[4 + e]] : 0.5 * (x[i] + x[j]);
  }
  return x;
}

/// Volume and centroid: det J is cubic and x quadratic, so the 15-point rule is exact.
void measure(const std::array<Vec3, 10>& x, double& volume, Vec3& centroid) {
  static const auto rule = mesh::tet_quadrature_15();
  volume = 0;
  centroid.setZero();
  for (const auto& point : rule) {
    const double w =
        point.weight * mesh::tet10_jacobian(x, mesh::tet10_gradients(point.xi)).determinant();
    const auto n = mesh::tet10_shape(point.xi);
    Vec3 position = Vec3::Zero();
    for (int i = 0; i < 10; ++i) position += n[i] * x[i];
    volume += w;
    centroid += w * position;
  }
  centroid /= volume;
}

/// Share of each quadrature point in its element's value; they add up to 1. At the centroid: the
/// first of fifteen points, which lies there, or the best linear function through the points, which
/// by the symmetry of the rules is their mean with the weights of the rule.
std::vector<double> point_weights(const std::array<Vec3, 10>& x, int points, ElementValue value) {
  if (points == 1) return {1.0};
  std::vector<double> w;
  if (points == 15 && value == ElementValue::centroid) {
    w.assign(15, 0.0);
    w[0] = 1;
    return w;
  }
  double total = 0;
  for (const auto& point : mesh::tet_quadrature(points)) {
    w.push_back(point.weight);
    if (value == ElementValue::average)
      w.back() *= mesh::tet10_jacobian(x, mesh::tet10_gradients(point.xi)).determinant();
    total += w.back();
  }
  for (double& share : w) share /= total;
  return w;
}

/// The values of some elements, [elements][points][components].
struct Piece {
  int components = 0;
  std::size_t each = 0;  // values of an element
  std::vector<double> values;
  /// Values of an element, counted from the first one of the piece.
  const double* of(std::size_t element) const { return &values[element * each]; }
};

/// Elements first ... last - 1 of a field whose size is checked; none if there is no such field.
std::optional<Piece> piece_of(const mesh::Snapshot& s, const mesh::FieldReader& read,
                              const char* name, Location location, std::size_t first,
                              std::size_t last, int components = 0) {
  const auto* field = s.find(name, location);
  if (field == nullptr) return std::nullopt;
  Piece piece{field->components, mesh::values_each(s, *field), {}};
  if (components == 0 || field->components == components) piece.values = read(*field, first, last);
  if (piece.values.size() != (last - first) * piece.each)
    throw core::InternalError(
        fmt::format("results/element_values: field {} has {} components and {} values for {} "
                    "elements",
                    name, field->components, piece.values.size(), last - first));
  return piece;
}

/// Weighted values of one element, component by component.
template <int N>
Eigen::Matrix<double, N, 1> mean(const Piece& field, std::size_t element,
                                 std::span<const double> weights) {
  Eigen::Matrix<double, N, 1> sum = Eigen::Matrix<double, N, 1>::Zero(field.components);
  const double* v = field.of(element);
  for (std::size_t p = 0; p < weights.size(); ++p)
    for (int c = 0; c < field.components; ++c) sum[c] += weights[p] * *v++;
  return sum;
}

core::Quaternion mean_quaternion(const Piece& field, std::size_t element,
                                 std::span<const double> weights) {
  std::vector<core::Quaternion> q;
  for (std::size_t p = 0; p < weights.size(); ++p) {
    const double* v = field.of(element) + 4 * p;
    q.emplace_back(v[0], v[1], v[2], v[3]);
  }
  return core::mean_rotation(q, weights);
}

/// The value at the centroid, made a unit quaternion again; signs as the first point's.
core::Quaternion centroid_quaternion(const Piece& field, std::size_t element,
                                     std::span<const double> weights) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  const double* first = field.of(element);
  for (std::size_t p = 0; p < weights.size(); ++p) {
    const Eigen::Map<const Eigen::Vector4d> q(first + 4 * p), q0(first);
    sum += weights[p] * (q.dot(q0) < 0 ? Eigen::Vector4d(-q) : Eigen::Vector4d(q));
  }
  if (!(sum.norm() > 0))
    throw core::InternalError("results/element_values: an element without mean orientation");
  sum.normalize();
  return {sum[0], sum[1], sum[2], sum[3]};
}

core::Vec6 plain(const double* v) { return Eigen::Map<const core::Vec6>(v); }

}  // namespace

ElementTable element_values(const mesh::Snapshot& s, ElementValue value) {
  return element_values(s, mesh::reader_of(s), value, 0, s.mesh.tetrahedra.size());
}

ElementTable element_values(const mesh::Snapshot& s, const mesh::FieldReader& read,
                            ElementValue value, std::size_t first, std::size_t last) {
  const auto points = Location::quadrature_point;
  const auto piece = [&](const char* name, Location location, int components = 0) {
    return piece_of(s, read, name, location, first, last, components);
  };
  const auto orientation = piece("orientation", points, 4);
  const auto g = piece("g", points);
  const auto slip = piece("slip", points);
  const auto strain = piece("equivalent_strain", points, 1);
  const auto stress = piece("cauchy_stress", points, 6);
  const auto element_stress = piece("cauchy_stress", Location::element, 6);
  const auto pressure = piece("pressure", Location::element, 1);

  const std::size_t n = last - first;
  ElementTable t;
  t.volume.resize(n);
  t.centroid.resize(n);
  t.orientation.assign(n, {unset, unset, unset, unset});
  t.g.assign(n, unset);
  t.slip.assign(n, unset);
  t.equivalent_strain.assign(n, unset);
  t.cauchy_stress.assign(n, core::Vec6::Zero());
  t.pressure.resize(n);
  for (std::size_t e = 0; e < n; ++e) {
    const auto x = element_nodes(s.mesh, static_cast<int>(first + e));
    measure(x, t.volume[e], t.centroid[e]);
    const auto w = point_weights(x, s.quadrature_points, value);
    if (orientation)
      t.orientation[e] = value == ElementValue::average ? mean_quaternion(*orientation, e, w)
                                                        : centroid_quaternion(*orientation, e, w);
    if (g) t.g[e] = mean<Eigen::Dynamic>(*g, e, w).mean();
    if (slip) t.slip[e] = mean<Eigen::Dynamic>(*slip, e, w).sum();
    if (strain) t.equivalent_strain[e] = mean<1>(*strain, e, w)[0];
    if (stress)
      t.cauchy_stress[e] = mean<6>(*stress, e, w);
    else if (element_stress)
      t.cauchy_stress[e] = plain(element_stress->of(e));
    t.pressure[e] =
        !stress && pressure ? *pressure->of(e) : -t.cauchy_stress[e].head<3>().sum() / 3;
  }
  return t;
}

}  // namespace polyslip::results
