#pragma once
// What a run says: lines of the log, the summary, its last lines.

#include <mpi.h>

#include <string>
#include <utility>
#include <vector>

#include "core/log.hpp"
#include "core/timer.hpp"
#include "drivers/options.hpp"
#include "drivers/run_progress.hpp"
#include "mesh/snapshot.hpp"
#include "remap/remesh.hpp"
#include "results/state_series.hpp"
#include "results/summary.hpp"
#include "solver/model.hpp"

namespace polyslip::drivers {

using CpuSeconds = std::vector<std::pair<std::string, double>>;

/// "strain 0.1200  stress 27.31 MPa  step 0.02  Newton 2  linear 9  worst element 0.31  2 min left"
std::string step_text(const solver::StepRecord& step, double seconds_left);

std::string remeshing_text(const remap::RemeshReport& report);
/// remeshing-NNN.csv: a row a grain (docs/results-format.md).
std::string remeshing_table(const remap::RemeshReport& report);
results::RemeshingSummary remeshing_summary(const remap::RemeshReport& report);

/// What earlier sessions and this one took, by stage.
CpuSeconds total_times(const CpuSeconds& earlier, const core::StageTimes& times);
/// The same, this session's over all ranks. Collective; earlier ones count on rank 0.
CpuSeconds sum_over_ranks(MPI_Comm comm, const CpuSeconds& earlier, const core::StageTimes& times);
double sum_over_ranks(MPI_Comm comm, double value);

/// All but times, memory and `completed`.
results::Summary summarise(const RunProgress& progress, const Options& options,
                           const mesh::Snapshot& last);

/// Draws the picture and says, as the last lines, what came out and where it lies.
void report_end(const std::string& folder, const results::StateSeries& states,
                const results::Summary& summary, core::Log& log);

/// Writes report.html. What prevents it is a warning: the results are there all the same.
void make_report(const std::string& folder, const TextureOptions& texture, core::Log& log);

}  // namespace polyslip::drivers
