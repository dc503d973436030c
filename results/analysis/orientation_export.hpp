#pragma once
// Orientations for other programs.

#include <string>

#include "results/analysis/sample.hpp"
#include "results/xdmf.hpp"

namespace polyslip::results::analysis {

/// Text that MTEX's generic interface reads: a header line "# phi1 Phi phi2 weights", then Bunge's
/// angles [degrees] and the share of the volume. MTEX's orientations, too, take crystal to specimen
/// coordinates.
std::string mtex_text(const Sample& sample);

/// Neper's orientation file: "w x y z" a line, to be read as quaternion:passive. It has no place
/// for weights.
std::string ori_text(const Sample& sample);

/// Which format a name asks for: "ori" for .ori, else "csv" (a table, results/convert.hpp).
std::string export_format(const std::string& path);

/// Writes the orientations of the stored state nearest to `strain` as "mtex" or "ori" and returns
/// which it was. InputError as results::convert; an earlier file is replaced only if `overwrite`.
StateRecord export_orientations(const std::string& run_folder, double strain,
                                const std::string& path, const std::string& format, bool overwrite);

}  // namespace polyslip::results::analysis
