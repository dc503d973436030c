#pragma once
// Orientations as Neper's files hold them: a descriptor such as "rodrigues:passive", then numbers.
//
// A descriptor's numbers give a rotation D by the usual active formulas:
//   rodrigues    r1 r2 r3: axis r, angle 2 atan|r|;
//   quaternion   w x y z, a unit quaternion;
//   axis-angle   t1 t2 t3 angle: axis t, angle in degrees;
//   euler-bunge  phi1 Phi phi2 in degrees: D = Rz(phi1) Rx(Phi) Rz(phi2);
//   euler-kocks  Psi Theta phi in degrees: Bunge angles Psi + 90, Theta, 90 - phi;
//   euler-roe    psi theta phi in degrees: Bunge angles psi + 90, theta, phi - 90;
//   rotmat       nine numbers, row by row: D^T.
// "passive" (crystal to sample): our orientation, whose columns are the crystal axes in the sample
// frame, is D; "active" (sample to crystal), or nothing: it is D^T. That is so in results of FEPX
// on Neper's meshes ("rodrigues:passive"), and the descriptors agree with each other as in Neper's
// own tables.

#include <span>
#include <string>

#include "core/types.hpp"
#include "mesh/text_scanner.hpp"

namespace polyslip::core {
class FileWriter;
}

namespace polyslip::mesh {

enum class OrientationKind { rodrigues, quaternion, axis_angle, bunge, kocks, roe, matrix };

struct OrientationDescriptor {
  OrientationKind kind = OrientationKind::rodrigues;
  bool passive = true;
};

/// Takes the descriptor. InputError for one that is not above.
OrientationDescriptor read_orientation_descriptor(TextScanner& in);

/// Takes the numbers of one orientation. Quaternions and axes need a length of 1 within 1e-3 (axes:
/// any but 0), matrices to be rotations within 1e-3.
core::Quaternion read_orientation(TextScanner& in, const OrientationDescriptor& descriptor);

/// The descriptor that we write: one that any rotation has numbers of.
inline const std::string written_descriptor = "quaternion:passive";
/// " w x y z", in the shortest form that reads back to the same numbers.
void put_orientation(core::FileWriter& out, const core::Quaternion& orientation);

}  // namespace polyslip::mesh
