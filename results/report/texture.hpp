#pragma once
// Texture and microtexture for the page: numbers as JSON, densities as binary blocks.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"
#include "results/analysis/grain_figures.hpp"
#include "results/report/block.hpp"
#include "results/report/maps.hpp"

namespace polyslip::results::report {

/// Of a run or a Taylor model.
struct Texture {
  analysis::Analysis analysis;
  std::vector<StateMaps> maps;                 ///< [analysis.textures]
  std::vector<analysis::GrainPicture> grains;  ///< the two largest, if there is a spread
};
Texture texture_of(const analysis::Analysis& analysis);

/// Adds a block "<name>-<state>" a state to `blocks`: float32 densities of its maps.
nlohmann::ordered_json texture_json(const Texture& texture, const std::string& name,
                                    std::vector<Block>& blocks);

/// Spreads of each grain at each state, their means, and the grains that are drawn; adds a block
/// "grain-<number>" of each of these: float32, its pole figure {111} and its deviations.
nlohmann::ordered_json spreads_json(const Texture& texture, std::vector<Block>& blocks);

}  // namespace polyslip::results::report
