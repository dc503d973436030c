#include "remap/donor_average.hpp"

#include <span>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::remap {
namespace {

using core::Quaternion;
using core::Vec3;

Quaternion quaternion_at(const std::vector<double>& values, std::size_t index) {
  return {values[4 * index], values[4 * index + 1], values[4 * index + 2], values[4 * index + 3]};
}

}  // namespace

std::vector<double> point_volumes(const mesh::Snapshot& snapshot) {
  const auto rule = mesh::tet_quadrature(snapshot.quadrature_points);
  std::vector<std::array<Vec3, 10>> gradients;
  for (const auto& point : rule) gradients.push_back(mesh::tet10_gradients(point.xi));
  std::vector<double> volumes;
  volumes.reserve(snapshot.mesh.tetrahedra.size() * rule.size());
  for (const auto& tetrahedron : snapshot.mesh.tetrahedra) {
    std::array<Vec3, 10> x;
    for (int i = 0; i < 10; ++i) x[i] = snapshot.mesh.nodes[tetrahedron[i]];
    for (std::size_t q = 0; q < rule.size(); ++q)
      volumes.push_back(rule[q].weight * mesh::tet10_jacobian(x, gradients[q]).determinant());
  }
  return volumes;
}

std::vector<double> element_means(const mesh::Snapshot& snapshot, const mesh::Field& field) {
  const std::vector<double> volumes = point_volumes(snapshot);
  const std::size_t points = static_cast<std::size_t>(snapshot.quadrature_points);
  const std::size_t components = static_cast<std::size_t>(field.components);
  const std::size_t elements = snapshot.mesh.tetrahedra.size();
  std::vector<double> means(elements * components, 0.0);
  for (std::size_t e = 0; e < elements; ++e) {
    if (field.transport == core::Transport::orientation_average) {
      std::vector<Quaternion> orientations;
      for (std::size_t q = 0; q < points; ++q)
        orientations.push_back(quaternion_at(field.values, e * points + q));
      const Quaternion mean = core::mean_rotation(
          orientations, std::span<const double>(volumes).subspan(e * points, points));
      means[4 * e] = mean.w();
      means[4 * e + 1] = mean.x();
      means[4 * e + 2] = mean.y();
      means[4 * e + 3] = mean.z();
      continue;
    }
    double volume = 0;
    for (std::size_t q = 0; q < points; ++q) {
      volume += volumes[e * points + q];
      for (std::size_t c = 0; c < components; ++c)
        means[e * components + c] +=
            volumes[e * points + q] * field.values[(e * points + q) * components + c];
    }
    for (std::size_t c = 0; c < components; ++c) means[e * components + c] /= volume;
  }
  return means;
}

std::vector<Quaternion> grain_orientations(const mesh::Snapshot& snapshot) {
  const mesh::Field* orientation = snapshot.find("orientation");
  if (!orientation) throw core::InternalError("the snapshot has no orientations");
  const std::vector<double> volumes = point_volumes(snapshot);
  const std::size_t points = static_cast<std::size_t>(snapshot.quadrature_points);
  const std::size_t grains = snapshot.mesh.topology.cell_faces.size();
  std::vector<std::vector<Quaternion>> orientations(grains);
  std::vector<std::vector<double>> weights(grains);
  for (std::size_t e = 0; e < snapshot.mesh.tetrahedra.size(); ++e) {
    const std::size_t grain = static_cast<std::size_t>(snapshot.mesh.tetrahedron_cell[e]);
    for (std::size_t q = 0; q < points; ++q) {
      orientations[grain].push_back(quaternion_at(orientation->values, e * points + q));
      weights[grain].push_back(volumes[e * points + q]);
    }
  }
  std::vector<Quaternion> means;
  for (std::size_t g = 0; g < grains; ++g)
    means.push_back(core::mean_rotation(orientations[g], weights[g]));
  return means;
}

}  // namespace polyslip::remap
