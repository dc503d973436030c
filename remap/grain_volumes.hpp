#pragma once
// Elastic compression through a remeshing that sets stresses to zero (docs/theory.md: (R.5)).

#include "mesh/snapshot.hpp"

namespace polyslip::remap {

/// Gives every grain of `fresh` the volume ratio V/V0 and the mean pressure that it has in `old`,
/// alike in all of its elements, and hydrostatic stress to match; "fresh" has stress fields, zero.
/// So no volume at zero pressure is lost. Adds the fields "volume", "reference_volume" and, where
/// `old` has it, "volume_ratio". A state without volumes at zero pressure is left as it is: it has
/// no pressure.
void keep_grain_compression(const mesh::Snapshot& old, mesh::Snapshot& fresh);

}  // namespace polyslip::remap
