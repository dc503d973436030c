#pragma once
// Plots that stand beside the figures of the paper (docs/figures.md), one command each.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/tessellation.hpp"
#include "mesh/volume_mesher.hpp"
#include "results/plot.hpp"

namespace polyslip::figures {

struct Options {
  int cubes = 0;   ///< polycrystals; 0: as many as the figure wants
  int grains = 0;  ///< of each; 0: as many as the figure wants
  std::uint64_t seed = 1;
  double element_size = 0.25;  ///< c_l
  int jobs = 0;
  std::string worker;               ///< polyslip-mesher
  std::vector<std::string> tables;  ///< CSV files of mesh_quality, for table 1
};

/// A plot, and what it shows as lines of Markdown.
struct Figure {
  std::string caption;
  std::vector<results::Plot> panels;
  std::string text;
};

using Maker = std::function<Figure(const Options&)>;

/// Figures by name: "2", ..., "table-1".
std::map<std::string, Maker> tessellation_figures();
std::map<std::string, Maker> mesh_figures();
std::map<std::string, Maker> table_figures();

/// Line through the centres of a histogram's bins.
results::Series curve_of(const results::Histogram& histogram, const std::string& label);

/// The same of values, in bins over [from, to].
results::Series curve_of(const std::vector<double>& values, double from, double to, int bins,
                         const std::string& label);

/// The paper's regularisation.
mesh::RegularisationOptions paper_regularisation(double max_edge_length, double max_fault = 20);

}  // namespace polyslip::figures
