#include "remap/transport.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"
#include "remap/donor_average.hpp"
#include "remap/grain_correction.hpp"
#include "remap/grain_volumes.hpp"
#include "remap/locator.hpp"
#include "remap/point_shares.hpp"

namespace polyslip::remap {
namespace {

using core::Transport;
using core::Vec3;
using mesh::Field;
using mesh::Location;

/// Where the entities of the new mesh take their values from.
struct Donors {
  std::vector<int> element;              ///< [new elements]
  std::vector<std::size_t> point;        ///< [new points] point of the old mesh; by points only
  std::vector<remap::Location> of_node;  ///< [new nodes]
};

Vec3 place(const mesh::Mesh& mesh, std::size_t element, const std::array<double, 10>& shape) {
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 10; ++i) x += shape[i] * mesh.nodes[mesh.tetrahedra[element][i]];
  return x;
}

/// The old element of the same grain that holds a point of a new element.
remap::Location donor_at(const mesh::Mesh& mesh, std::size_t element, const Vec3& x,
                         const ElementLocator& locator) {
  const int cell = mesh.tetrahedron_cell[element];
  const remap::Location found = locator.find(x, cell);
  if (found.element < 0)
    throw core::InternalError("transport: grain " + std::to_string(cell + 1) +
                              " has no elements in the old mesh");
  return found;
}

std::vector<int> donors_of_centroids(const mesh::Mesh& mesh, const ElementLocator& locator,
                                     int threads) {
  const auto shape = mesh::tet10_shape(Vec3::Constant(0.25));
  std::vector<int> result(mesh.tetrahedra.size());
  core::parallel_for(threads, result.size(), [&](std::size_t e) {
    result[e] = donor_at(mesh, e, place(mesh, e, shape), locator).element;
  });
  return result;
}

/// For each new point, the nearest point of the old element of the same grain that holds the
/// centroid of its share.
std::vector<std::size_t> donors_of_points(const mesh::Mesh& mesh,
                                          std::span<const mesh::QuadraturePoint> rule,
                                          const ElementLocator& locator, int threads) {
  std::vector<std::array<double, 10>> shapes;
  for (const Vec3& centroid : share_centroids(rule)) shapes.push_back(mesh::tet10_shape(centroid));
  std::vector<std::size_t> result(mesh.tetrahedra.size() * rule.size());
  core::parallel_for(threads, mesh.tetrahedra.size(), [&](std::size_t e) {
    for (std::size_t q = 0; q < rule.size(); ++q) {
      const auto found = donor_at(mesh, e, place(mesh, e, shapes[q]), locator);
      result[e * rule.size() + q] =
          static_cast<std::size_t>(found.element) * rule.size() + nearest_point(rule, found.xi);
    }
  });
  return result;
}

/// For each node of `mesh`, the place in the old mesh; any grain of the node serves, the field is
/// continuous.
std::vector<remap::Location> node_places(const mesh::Mesh& mesh, const ElementLocator& locator,
                                         int threads) {
  std::vector<int> cell(mesh.nodes.size(), -1);
  for (std::size_t e = mesh.tetrahedra.size(); e-- > 0;)
    for (int node : mesh.tetrahedra[e]) cell[node] = mesh.tetrahedron_cell[e];
  std::vector<remap::Location> places(mesh.nodes.size());
  core::parallel_for(threads, places.size(),
                     [&](std::size_t n) { places[n] = locator.find(mesh.nodes[n], cell[n]); });
  return places;
}

Field empty_like(const Field& field, std::size_t entities) {
  Field result = field;
  result.values.assign(entities * static_cast<std::size_t>(field.components), 0.0);
  return result;
}

/// values(new node) = sum_i N_i(xi) values(old node i)
Field interpolate(const Field& field, const mesh::Mesh& old_mesh,
                  const std::vector<remap::Location>& places) {
  Field result = empty_like(field, places.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const auto shape = mesh::tet10_shape(places[n].xi);
    for (int i = 0; i < 10; ++i) {
      const std::size_t from = old_mesh.tetrahedra[places[n].element][i];
      for (int c = 0; c < field.components; ++c)
        result.values[n * field.components + c] +=
            shape[i] * field.values[from * field.components + c];
    }
  }
  return result;
}

/// values[from] for each entity of the new mesh, `copies` times.
template <class Index>
Field copy_from(const Field& field, const std::vector<double>& values, int copies,
                const std::vector<Index>& donor) {
  const std::size_t components = static_cast<std::size_t>(field.components);
  Field result = empty_like(field, donor.size() * copies);
  auto out = result.values.begin();
  for (const Index from : donor)
    for (int copy = 0; copy < copies; ++copy)
      out = std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from * components), components,
                        out);
  return result;
}

class Carrier {
 public:
  Carrier(const mesh::Snapshot& old, const Donors& donors, bool with_stress)
      : old_(old), donors_(donors), with_stress_(with_stress) {}

  bool carries(const Field& field) const { return field.transport != Transport::not_carried; }

  Field operator()(const Field& field) const {
    switch (field.transport) {
      case Transport::shape_functions:
        if (field.location != Location::node)
          throw core::InternalError("transport: field '" + field.name + "' is not nodal");
        return interpolate(field, old_.mesh, donors_.of_node);
      case Transport::reset_to_zero:
        return with_stress_ && field.location != Location::node ? by_donors(field) : zero(field);
      case Transport::element_average:
      case Transport::orientation_average:
        if (field.location == Location::node)
          throw core::InternalError("transport: nodal field '" + field.name +
                                    "' has no element average");
        return by_donors(field);
      case Transport::not_carried:
        break;
    }
    throw core::InternalError("transport: field '" + field.name + "' is not carried");
  }

  Field by_donors(const Field& field) const {
    if (field.location == Location::element)
      return copy_from(field, field.values, 1, donors_.element);
    if (!donors_.point.empty()) return copy_from(field, field.values, 1, donors_.point);
    return copy_from(field, element_means(old_, field), old_.quadrature_points, donors_.element);
  }

 private:
  Field zero(const Field& field) const {
    const std::size_t elements = donors_.element.size();
    switch (field.location) {
      case Location::node:
        return empty_like(field, donors_.of_node.size());
      case Location::element:
        return empty_like(field, elements);
      case Location::quadrature_point:
        return empty_like(field, elements * static_cast<std::size_t>(old_.quadrature_points));
    }
    throw core::InternalError("transport: no such location");
  }

  const mesh::Snapshot& old_;
  const Donors& donors_;
  bool with_stress_;
};

/// Volumes at zero pressure such that V/V0 is the donor's: the pressure that is carried then
/// belongs to the volumes. So does the ratio at the points, of elements that have one there.
void carry_volumes(const mesh::Snapshot& old, const std::vector<int>& donor, const Carrier& carry,
                   mesh::Snapshot& fresh) {
  const Field* volume = old.find("volume", Location::element);
  const Field* reference = old.find("reference_volume", Location::element);
  if (!volume || !reference)
    throw core::InternalError("transport: a state without volumes has no stress to carry");
  const auto points = point_volumes(fresh);
  const auto count = static_cast<std::size_t>(fresh.quadrature_points);
  Field now = empty_like(*volume, donor.size()), at_zero = empty_like(*reference, donor.size());
  for (std::size_t e = 0; e < donor.size(); ++e) {
    for (std::size_t q = 0; q < count; ++q) now.values[e] += points[e * count + q];
    at_zero.values[e] = now.values[e] * reference->values[donor[e]] / volume->values[donor[e]];
  }
  fresh.fields.push_back(std::move(now));
  fresh.fields.push_back(std::move(at_zero));
  if (const Field* ratio = old.find("volume_ratio", Location::quadrature_point))
    fresh.fields.push_back(carry.by_donors(*ratio));
}

}  // namespace

mesh::Snapshot transport(const mesh::Snapshot& old, mesh::Mesh mesh,
                         const TransportOptions& options, int threads) {
  const ElementLocator locator(old.mesh);
  Donors donors;
  donors.element = donors_of_centroids(mesh, locator, threads);
  donors.of_node = node_places(mesh, locator, threads);
  if (options.state != "element")
    donors.point =
        donors_of_points(mesh, mesh::tet_quadrature(old.quadrature_points), locator, threads);

  mesh::Snapshot result;
  result.mesh_number = old.mesh_number + 1;
  result.quadrature_points = old.quadrature_points;
  result.time = old.time;
  result.strain = old.strain;
  result.provenance = old.provenance;
  const Carrier carry(old, donors, options.stress == "carried");
  for (const Field& field : old.fields)
    if (carry.carries(field)) result.fields.push_back(carry(field));
  result.mesh = std::move(mesh);
  if (options.state == "corrected") correct_grains(old, result, threads);
  if (options.stress == "carried")
    carry_volumes(old, donors.element, carry, result);
  else
    keep_grain_compression(old, result);
  return result;
}

}  // namespace polyslip::remap
