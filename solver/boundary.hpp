#pragma once
// What is prescribed on the boundary, as a function of strain. A type of load is one function that
// makes a Boundary.

#include <cstdint>
#include <functional>
#include <vector>

#include "core/types.hpp"
#include "solver/options.hpp"

namespace polyslip::solver {

/// A face of the box (0 ... 5: x0 x1 y0 y1 z0 z1) kept planar: this coordinate of all its nodes.
struct FaceMotion {
  int face = 0;
  int component = 0;
  std::function<double(double strain)> position;  ///< of the face along `component`
};

struct Boundary {
  std::vector<FaceMotion> faces;
  /// If set, every node of the domain boundary is prescribed in all components: its position from
  /// its initial one and the strain. `faces` is not read then.
  std::function<core::Vec3(const core::Vec3& initial, double strain)> all;
  /// Homogeneous deformation from zero strain that satisfies the prescribed motion; the predictor
  /// starts from it. Positive determinant.
  std::function<core::Mat3(double strain)> mean_gradient;

  /// Whether `component` of a node on the domain faces `node_faces` (bit f) is prescribed.
  bool constrains(std::uint8_t node_faces, int component) const;
  /// Whether this face itself prescribes `component`.
  bool face_constrains(int face, int component) const;
  /// Prescribed position; call only where `constrains`.
  double position(std::uint8_t node_faces, int component, const core::Vec3& initial,
                  double strain) const;
};

/// The boundary of a deck. size: box at zero strain.
/// "plane-strain-compression": x0, y0, z0 stay at 0, y1 at size y, z1 at size z exp(-strain), all
/// free of shear; x1 is free. Throws core::InputError for an unknown type.
Boundary make_boundary(const LoadingOptions& loading, const core::Vec3& size);

}  // namespace polyslip::solver
