#pragma once
// Single grains: how they turn, and how their orientations spread (figs. 13 and 19 of the paper).

#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"
#include "results/analysis/texture_maps.hpp"
#include "results/plot.hpp"

namespace polyslip::results::analysis {

/// One grain through all states of an analysis.
struct GrainPicture {
  int grain = 0;  ///< from 0
  /// Upper ends of the <111> axes of its mean orientation from state to state (equal-area), cut
  /// where they cross the rim.
  std::vector<std::vector<Place>> paths;
  DiscGrid poles;  ///< {111} of its orientations in the last state, half-width of 4 degrees
  std::vector<core::Vec3> deviations;  ///< [elements] in the last state, disorientation_vectors
};
GrainPicture grain_picture(const Analysis& analysis, int grain);

/// The grains to draw: those asked for (from 0), or the two largest that count. InputError for one
/// that is not there.
std::vector<int> drawn_grains(const Analysis& analysis, const std::vector<int>& asked);

/// Where a grain's orientations lie about their mean in the last state (fig. 19): components of
/// rotation vectors, degrees.
std::vector<Plot> grain_plots(const Analysis& analysis, const GrainPicture& picture);
/// {111} pole figures of grains: the path of the mean and the density of the last state (fig. 13).
std::string path_svg(const Analysis& analysis, const std::vector<GrainPicture>& pictures);

}  // namespace polyslip::results::analysis
