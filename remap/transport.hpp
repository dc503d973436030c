#pragma once
// State transport of section 2.3.3 (docs/theory.md: Transport).

#include <string>

#include "mesh/snapshot.hpp"

namespace polyslip::remap {

/// What a deck asks for in [remeshing].
struct TransportOptions {
  /// "element": each new element takes the mean of the old one that holds its centroid (the paper).
  /// "point": each new quadrature point takes the value at the nearest point of the old element
  /// that holds the centroid of its share (remap/point_shares.hpp). "corrected": the same, then
  /// each grain gets its mean orientation, its spread and its means of scalars back
  /// (remap/grain_correction.hpp).
  std::string state = "element";
  /// "zero": fields that core::Transport::reset_to_zero names vanish, but for each grain's mean
  /// pressure (remap/grain_volumes.hpp).
  /// "carried": they go with the state, and so do volumes over those at zero pressure.
  std::string stress = "zero";
};

/// State and nodal fields of `old` on `mesh`, within the same grain; nodal fields by shape
/// functions; see core::Transport. `threads` share the search. Throws InternalError if a grain has
/// no elements in the old mesh or a field's rule does not fit its location.
mesh::Snapshot transport(const mesh::Snapshot& old, mesh::Mesh mesh,
                         const TransportOptions& options = {}, int threads = 1);

}  // namespace polyslip::remap
