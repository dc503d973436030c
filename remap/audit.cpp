#include "remap/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "remap/donor_average.hpp"

namespace polyslip::remap {
namespace {

void compare_volumes(const mesh::Mesh& before, const mesh::Mesh& after,
                     const RemeshingOptions& options, RemeshReport& report) {
  const std::vector<double> old_volumes = mesh::grain_volumes(before);
  const std::vector<double> new_volumes = mesh::grain_volumes(after);
  if (old_volumes.size() != new_volumes.size())
    throw core::InternalError("remeshing changed the number of grains");
  double sum_of_squares = 0;
  std::size_t worst = 0;
  for (std::size_t g = 0; g < old_volumes.size(); ++g) {
    const double change = std::abs(new_volumes[g] / old_volumes[g] - 1);
    sum_of_squares += change * change;
    if (!(change <= report.max_grain_volume_change)) {
      report.max_grain_volume_change = change;
      worst = g;
    }
  }
  report.rms_grain_volume_change =
      std::sqrt(sum_of_squares / static_cast<double>(old_volumes.size()));
  if (!(report.max_grain_volume_change <= options.max_grain_volume_change))
    throw core::RecoverableError(
        fmt::format("remeshing at strain {:.6g}: the volume of grain {} changed by {:.3g} %, above "
                    "[remeshing] max_grain_volume_change = {:.3g} %",
                    report.strain, worst + 1, 100 * report.max_grain_volume_change,
                    100 * options.max_grain_volume_change));
}

void compare_orientations(const mesh::Snapshot& before, const mesh::Snapshot& after,
                          RemeshReport& report) {
  const auto old_means = grain_orientations(before);
  const auto new_means = grain_orientations(after);
  double sum = 0;
  for (std::size_t g = 0; g < old_means.size(); ++g) {
    const double angle = old_means[g].angularDistance(new_means[g]) * 180 / std::numbers::pi;
    report.max_mean_rotation = std::max(report.max_mean_rotation, angle);
    sum += angle;
  }
  report.mean_mean_rotation = sum / static_cast<double>(old_means.size());
}

}  // namespace

void audit(const mesh::Snapshot& before, const mesh::Snapshot& after,
           const RemeshingOptions& options, RemeshReport& report) {
  report.elements_before = before.mesh.element_count();
  report.elements_after = after.mesh.element_count();
  report.min_radius_ratio_before = mesh::quality(before.mesh).min_radius_ratio;
  report.min_radius_ratio_after = mesh::quality(after.mesh).min_radius_ratio;
  compare_volumes(before.mesh, after.mesh, options, report);
  if (before.find("orientation")) compare_orientations(before, after, report);
}

}  // namespace polyslip::remap
