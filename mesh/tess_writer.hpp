#pragma once
// Tessellations in Neper's .tess format.

#include <span>
#include <string>

#include "core/types.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {

/// What a file may say of cells beside their geometry. Spans are empty or have one entry a cell.
struct TessNotes {
  std::span<const core::Quaternion> orientations;  ///< as `*ori`, mesh/orientation_block.hpp
  std::span<const int> ids;                        ///< `*id`
  std::span<const double> seed_weights;            ///< of a Laguerre tessellation; else 0
  std::span<const int> groups;                     ///< `*group`
  std::string crystal;                             ///< `*crysym`: "cubic"; empty: not said
};

/// Writes the tessellation in Neper's .tess format (as its documentation describes it); numbers are
/// the shortest that read back to the same double, so that read_tess gives the same tessellation.
/// Written beside and renamed; InputError if that fails.
void write_tess(const Tessellation& tessellation, const std::string& path, const TessNotes& notes);

}  // namespace polyslip::mesh
