#pragma once
// Statistics as files: stats.json, tables and plots.

#include <string>
#include <vector>

#include "results/plot.hpp"
#include "results/statistics.hpp"

namespace polyslip::results {

/// elements.csv has a row an element up to so many elements; beyond, elements-histogram.csv stands
/// in for it.
inline constexpr long element_rows_limit = 1'000'000;

/// InputError if `folder` cannot be made or written to, or if it holds files of an earlier call and
/// `overwrite` is false. Touches nothing.
void check_statistics_folder(const std::string& folder, bool overwrite);

/// Makes the folder, removes such files of an earlier call, and writes stats.json, grains.csv,
/// faces.csv, edges.csv, elements.csv and the plots; those of elements only if there is a mesh.
/// Returns the names, in the order written.
std::vector<std::string> write_statistics(const std::string& folder, const Statistics& statistics,
                                          const mesh::Mesh* mesh, const std::string& source);

/// Plots by file name: "grains.svg", "faces-and-edges.svg", "elements.svg", "grain-meshes.svg".
std::vector<std::pair<std::string, std::vector<Plot>>> statistics_plots(
    const Statistics& statistics);

}  // namespace polyslip::results
