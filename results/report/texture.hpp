#pragma once
// Texture and microtexture for the page: numbers as JSON, densities as binary blocks.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "results/analysis/analysis.hpp"
#include "results/report/block.hpp"
#include "results/report/maps.hpp"

namespace polyslip::results::report {

/// Of a run or a Taylor model.
struct Texture {
  analysis::Analysis analysis;
  std::vector<StateMaps> maps;  ///< [analysis.textures]
};
Texture texture_of(const analysis::Analysis& analysis);

/// Adds a block "<name>-<state>" a state to `blocks`: float32 densities of its maps.
nlohmann::ordered_json texture_json(const Texture& texture, const std::string& name,
                                    std::vector<Block>& blocks);

/// Spreads of each grain at each state, and their means.
nlohmann::ordered_json spreads_json(const analysis::Analysis& analysis);

}  // namespace polyslip::results::report
