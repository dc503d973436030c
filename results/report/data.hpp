#pragma once
// What the page is given: the results of a run folder as JSON and binary blocks. docs/report.md.

#include <string>
#include <utility>
#include <vector>

#include "results/distribution.hpp"
#include "results/report/macro_table.hpp"
#include "results/report/state_values.hpp"
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

struct Block {
  std::string name, text;  ///< base64 of a gzip stream
};

struct ReportData {
  std::string title;
  std::string summary;  ///< text of summary.json; empty if the run has left none
  std::string deck, resolved_deck;
  MacroTable macro;
  std::vector<StateDigest> states;
  std::vector<std::pair<std::string, std::string>> provenance;
  std::vector<Block> blocks;
};

/// InputError, one line, if the folder holds no stored states of a run, or a file is damaged.
ReportData gather(const std::string& folder);

/// Schema "polyslip-report/1".
std::string json_text(const ReportData& data);

}  // namespace polyslip::results::report
