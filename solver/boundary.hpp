#pragma once
// What is prescribed on the boundary, as a function of the load strain. A type of load is one
// function that makes a Boundary (docs/theory-solver.md, Boundary).

#include <cstdint>
#include <functional>
#include <vector>

#include "core/types.hpp"
#include "solver/options.hpp"

namespace polyslip::solver {

/// One component of the motion of a face of the box (0 ... 5: x0 x1 y0 y1 z0 z1).
struct FaceMotion {
  int face = 0;
  int component = 0;
  /// Of all nodes of the face along `component`; or, if `relative`, added to each node's initial
  /// coordinate.
  std::function<double(double strain)> position;
  bool relative = false;
};

/// A face that stays flat, normal to its axis, where the load's mean traction puts it.
struct PlanarFace {
  int face = 0;
  std::function<double(double path)> traction;  ///< mean normal traction [MPa], pulls if positive

  int component() const { return face / 2; }
  double outward() const { return face % 2 == 0 ? -1 : 1; }
};

/// A node that stays at its initial coordinate: the one on exactly these domain faces.
struct HeldNode {
  std::uint8_t faces = 0;  ///< bit f: on face f; three of them make a corner
  int component = 0;
};

struct Boundary {
  std::vector<FaceMotion> faces;
  std::vector<PlanarFace> planar;
  std::vector<HeldNode> held;
  /// If set, every node of the domain boundary is prescribed in all components: its position from
  /// its initial one and the strain. The lists above are not read then.
  std::function<core::Vec3(const core::Vec3& initial, double strain)> all;
  /// Homogeneous deformation from zero strain that satisfies the prescribed motion; the predictor
  /// starts from it. Positive determinant.
  std::function<core::Mat3(double strain)> mean_gradient;

  /// Whether `component` of a node on the domain faces `node_faces` (bit f) is no unknown of its
  /// own: prescribed, or that of a planar face.
  bool constrains(std::uint8_t node_faces, int component) const;
  /// Whether this face itself does so.
  bool face_constrains(int face, int component) const;
  /// Whether it is that of a planar face (and not prescribed by another face).
  bool planar_constrains(std::uint8_t node_faces, int component) const;
  /// Prescribed position; call only where `constrains` and not `planar_constrains`.
  double position(std::uint8_t node_faces, int component, const core::Vec3& initial,
                  double strain) const;

 private:
  bool moves(std::uint8_t node_faces, int component) const;
};

/// The boundary of a deck. size: box at zero strain, whose low corner is the origin. Throws
/// core::InputError for an unknown type.
Boundary make_boundary(const LoadingOptions& loading, const core::Vec3& size);

}  // namespace polyslip::solver
