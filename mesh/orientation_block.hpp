#pragma once
// Orientations as Neper's files hold them: a convention such as "rodrigues:passive", then numbers.

#include "core/types.hpp"
#include "mesh/text_scanner.hpp"

namespace polyslip::mesh {

/// Takes the convention: "rodrigues:passive", the only one read. InputError for another.
void read_orientation_convention(TextScanner& in);

/// Takes r1 r2 r3. The rotation of axis r and angle 2 atan|r| (the usual active formula) has the
/// crystal axes in the sample frame as the columns of its matrix: it is our quaternion as it
/// stands.
core::Quaternion read_orientation(TextScanner& in);

}  // namespace polyslip::mesh
