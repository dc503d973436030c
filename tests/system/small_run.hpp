#pragma once
// A small polycrystal through the whole program, and what its folder then says.

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/snapshot.hpp"
#include "results/state_series.hpp"
#include "support/program.hpp"

namespace polyslip::tests {

/// Eight grains to a strain of 0.06, remeshed at 0.03, with a checkpoint every 0.01. Further lines
/// go into [loading] and [solver].
std::string small_deck(const std::string& loading = "", const std::string& solver = "");

/// Steps all alike and tolerances of 1e-9: runs that may differ by rounding only.
std::string tight_deck();

/// One row of macro.csv.
struct MacroRow {
  double strain = 0, time = 0, step_size = 0;
  std::vector<double> stress;  ///< xx yy zz yz zx xy
  double fx_x1 = 0, fy_y1 = 0, fz_z1 = 0;
  int newton_iterations = 0, linear_iterations = 0, remeshed = 0;
  double von_mises() const;
};

/// All rows; a test failure, and what could be read, if one is not made of as many numbers as the
/// header.
std::vector<MacroRow> read_macro(const std::filesystem::path& run);

/// von Mises stress of the curve at this strain, linear between rows (from zero stress after a
/// remeshing and at the start).
double stress_at(const std::vector<MacroRow>& rows, double strain);

/// Number of lines in a file.
long line_count(const std::filesystem::path& file);

/// The last, or the n-th, stored state of a run.
mesh::Snapshot state_of(const std::filesystem::path& run, std::size_t number);
mesh::Snapshot last_state(const std::filesystem::path& run);
std::size_t state_count(const std::filesystem::path& run);

/// Mesh, fields, history, time and strain are the same, bit for bit.
void expect_identical(const mesh::Snapshot& a, const mesh::Snapshot& b);

/// Runs a deck in the sandbox to its end, into `folder`, with further options of the command line,
/// and expects that to go well.
void run_deck(const Sandbox& sandbox, int ranks, const std::string& deck, const std::string& folder,
              const std::vector<std::string>& options = {});

}  // namespace polyslip::tests
