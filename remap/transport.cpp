// State transport of section 2.3.3: 0-order by centroid within the same grain, nodal fields by the
// old element's shape functions.

#include <algorithm>

#include "core/error.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"
#include "remap/donor_average.hpp"
#include "remap/locator.hpp"
#include "remap/remesh.hpp"

namespace polyslip::remap {
namespace {

using core::Transport;
using core::Vec3;
using mesh::Field;
using mesh::Location;

/// For each new element, the old element of the same grain that holds its centroid.
std::vector<int> donors(const mesh::Mesh& mesh, const ElementLocator& locator) {
  const auto shape = mesh::tet10_shape(Vec3::Constant(0.25));
  std::vector<int> result(mesh.tetrahedra.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vec3 centroid = Vec3::Zero();
    for (int i = 0; i < 10; ++i) centroid += shape[i] * mesh.nodes[mesh.tetrahedra[e][i]];
    result[e] = locator.find(centroid, mesh.tetrahedron_cell[e]).element;
    if (result[e] < 0)
      throw core::InternalError("transport: grain " + std::to_string(mesh.tetrahedron_cell[e] + 1) +
                                " has no elements in the old mesh");
  }
  return result;
}

/// For each node of `mesh`, the place in the old mesh; any grain of the node serves, the field is
/// continuous.
std::vector<remap::Location> node_places(const mesh::Mesh& mesh, const ElementLocator& locator) {
  std::vector<remap::Location> places(mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e)
    for (int node : mesh.tetrahedra[e])
      if (places[node].element < 0)
        places[node] = locator.find(mesh.nodes[node], mesh.tetrahedron_cell[e]);
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

/// The donor's element mean at each of `copies` points of every new element.
Field copy_from_donors(const Field& field, const std::vector<double>& means, int copies,
                       const std::vector<int>& donor) {
  const std::size_t components = static_cast<std::size_t>(field.components);
  Field result = empty_like(field, donor.size() * copies);
  auto out = result.values.begin();
  for (int from : donor)
    for (int copy = 0; copy < copies; ++copy)
      out = std::copy_n(means.begin() + static_cast<std::ptrdiff_t>(from * components), components,
                        out);
  return result;
}

Field carry(const Field& field, const mesh::Snapshot& old, const std::vector<int>& donor,
            const std::vector<remap::Location>& places) {
  const int points = field.location == Location::quadrature_point ? old.quadrature_points : 1;
  switch (field.transport) {
    case Transport::shape_functions:
      if (field.location != Location::node)
        throw core::InternalError("transport: field '" + field.name + "' is not nodal");
      return interpolate(field, old.mesh, places);
    case Transport::reset_to_zero:
      return empty_like(field,
                        field.location == Location::node ? places.size() : donor.size() * points);
    case Transport::element_average:
    case Transport::orientation_average:
      if (field.location == Location::node)
        throw core::InternalError("transport: nodal field '" + field.name +
                                  "' has no element average");
      return copy_from_donors(field, points == 1 ? field.values : element_means(old, field), points,
                              donor);
    case Transport::not_carried:
      break;
  }
  throw core::InternalError("transport: field '" + field.name + "' is not carried");
}

}  // namespace

mesh::Snapshot transport(const mesh::Snapshot& old, mesh::Mesh mesh) {
  const ElementLocator locator(old.mesh);
  const std::vector<int> donor = donors(mesh, locator);
  const std::vector<remap::Location> places = node_places(mesh, locator);

  mesh::Snapshot result;
  result.mesh_number = old.mesh_number + 1;
  result.quadrature_points = old.quadrature_points;
  result.time = old.time;
  result.strain = old.strain;
  result.provenance = old.provenance;
  for (const Field& field : old.fields)
    if (field.transport != Transport::not_carried)
      result.fields.push_back(carry(field, old, donor, places));
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace polyslip::remap
