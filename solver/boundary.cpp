#include "solver/boundary.hpp"

#include <cmath>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

bool on(std::uint8_t node_faces, int face) { return ((node_faces >> face) & 1u) != 0; }

Boundary plane_strain_compression(const core::Vec3& size) {
  const auto fixed = [](double at) { return [at](double) { return at; }; };
  Boundary b;
  b.faces = {{0, 0, fixed(0)},
             {2, 1, fixed(0)},
             {3, 1, fixed(size[1])},
             {4, 2, fixed(0)},
             {5, 2, [h0 = size[2]](double strain) { return h0 * std::exp(-strain); }}};
  b.mean_gradient = [](double strain) -> core::Mat3 {
    return core::Vec3(std::exp(strain), 1, std::exp(-strain)).asDiagonal();
  };
  return b;
}

}  // namespace

bool Boundary::constrains(std::uint8_t node_faces, int component) const {
  if (all) return node_faces != 0;
  for (const auto& m : faces)
    if (m.component == component && on(node_faces, m.face)) return true;
  return false;
}

bool Boundary::face_constrains(int face, int component) const {
  if (all) return true;
  for (const auto& m : faces)
    if (m.component == component && m.face == face) return true;
  return false;
}

double Boundary::position(std::uint8_t node_faces, int component, const core::Vec3& initial,
                          double strain) const {
  if (all) return all(initial, strain)[component];
  for (const auto& m : faces)
    if (m.component == component && on(node_faces, m.face)) return m.position(strain);
  throw core::InternalError("Boundary::position: this component is free");
}

Boundary make_boundary(const LoadingOptions& loading, const core::Vec3& size) {
  if (loading.type == "plane-strain-compression") return plane_strain_compression(size);
  throw core::InputError("[loading] type = \"" + loading.type +
                         "\": not known; use \"plane-strain-compression\"");
}

}  // namespace polyslip::solver
