#pragma once
// What the page is given: the results of a run folder as JSON and binary blocks. docs/report.md.

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "results/analysis/analysis.hpp"
#include "results/distribution.hpp"
#include "results/report/block.hpp"
#include "results/report/macro_table.hpp"
#include "results/report/state_values.hpp"
#include "results/report/texture.hpp"
#include "results/xdmf.hpp"

namespace polyslip::results::report {

/// Of one stored state.
struct StateDigest {
  StateRecord record;
  std::string mesh_block, block;  ///< names of its blocks
  std::size_t surface_nodes = 0;
  std::array<core::Vec3, 2> box;
  std::array<Range, quantity_count> ranges;
  Histogram quality{0, 1, 40};  ///< of the elements' radius ratios, counted
  std::vector<core::Quaternion> grain_orientation;
  std::vector<double> grain_volume;
};

struct ReportData {
  std::string title;
  std::string summary;  ///< text of summary.json; empty if the run has left none
  std::string deck, resolved_deck;
  MacroTable macro;
  std::vector<StateDigest> states;
  std::vector<std::pair<std::string, std::string>> provenance;
  Texture texture;                                 ///< of the run
  nlohmann::ordered_json texture_values, spreads;  ///< made of it; texture.hpp
  nlohmann::ordered_json taylor;  ///< title, macro, texture of a Taylor model; or null
  std::vector<Block> blocks;
};

/// What a report is made of.
struct Sources {
  std::string folder = {};  ///< of a run
  std::string taylor = {};  ///< folder of the Taylor model to show beside it; empty: none
  analysis::AnalysisOptions texture = {};
};

/// InputError, one line, if the folder holds no stored states of a run, or a file is damaged.
ReportData gather(const Sources& sources);

/// Schema "polyslip-report/1".
std::string json_text(const ReportData& data);

}  // namespace polyslip::results::report
