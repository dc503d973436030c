#include "remap/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "remap/wear.hpp"

namespace polyslip::remap {
namespace {

/// Worst and mean over the grains of something that should be small.
struct Extent {
  double worst = 0, mean = 0, rms = 0;
  std::size_t grain = 0;
};

Extent extent(const RemeshReport& report,
              const std::function<double(const GrainStatistics&, const GrainStatistics&)>& change) {
  Extent e;
  const auto n = static_cast<double>(report.grains_before.size());
  for (std::size_t g = 0; g < report.grains_before.size(); ++g) {
    const double here = std::abs(change(report.grains_before[g], report.grains_after[g]));
    e.mean += here / n;
    e.rms += here * here / n;
    if (!(here <= e.worst)) {
      e.worst = here;
      e.grain = g;
    }
  }
  e.rms = std::sqrt(e.rms);
  return e;
}

double rotation(const GrainStatistics& a, const GrainStatistics& b) {
  return a.orientation.angularDistance(b.orientation) * core::degrees_per_radian;
}

double relative(double before, double after) { return before == after ? 0 : after / before - 1; }

class Limits {
 public:
  explicit Limits(double strain) : strain_(strain) {}
  void check(const Extent& e, double limit, const char* key, const char* text, double unit,
             const char* unit_name) {
    if (e.worst <= limit || !beyond_.empty()) return;
    beyond_ = fmt::format(
        "remeshing at strain {:.6g}: the {} of grain {} changed by {:.3g} {}, above [remeshing] {} "
        "= "
        "{:.3g} {}",
        strain_, text, e.grain + 1, unit * e.worst, unit_name, key, unit * limit, unit_name);
  }
  const std::string& beyond() const { return beyond_; }

 private:
  double strain_;
  std::string beyond_;
};

FieldStatistics over_grains(const std::vector<GrainStatistics>& grains,
                            FieldStatistics GrainStatistics::*field) {
  FieldStatistics all = grains.front().*field;
  all.mean = 0;
  double volume = 0;
  for (const GrainStatistics& g : grains) {
    all.min = std::min(all.min, (g.*field).min);
    all.max = std::max(all.max, (g.*field).max);
    all.mean += g.volume * (g.*field).mean;
    volume += g.volume;
  }
  all.mean /= volume;
  return all;
}

BodyStatistics body(const std::vector<GrainStatistics>& grains) {
  BodyStatistics b;
  b.g = over_grains(grains, &GrainStatistics::g);
  b.slip = over_grains(grains, &GrainStatistics::slip);
  for (const GrainStatistics& g : grains) {
    b.volume += g.volume;
    b.volume_at_zero_pressure += g.volume_at_zero_pressure;
    b.elastic_energy += g.elastic_energy;
  }
  for (const GrainStatistics& g : grains)
    b.mean_spread += g.spread / static_cast<double>(grains.size());
  return b;
}

/// Both volumes, by the ratio they have.
void set_volume(GrainStatistics& grain, double volume) {
  grain.volume_at_zero_pressure *= volume / grain.volume;
  grain.volume = volume;
}

/// Least radius ratio in the frame of sizes of a mesh made now: where these follow the body's shape
/// even perfect elements are flat in space.
double worst_radius_ratio(const mesh::Snapshot& s, const RemeshingOptions& options, int threads) {
  const core::Mat3 frame = meshing_scale(s.mesh, options).asDiagonal();
  return measure_wear(s.mesh.tetrahedra, s.mesh.nodes, {}, frame, {}, threads).worst_radius_ratio;
}

}  // namespace

std::string audit(const mesh::Snapshot& before, const mesh::Snapshot& after,
                  const RemeshingOptions& options, RemeshReport& report, int threads) {
  report.elements_before = before.mesh.element_count();
  report.elements_after = after.mesh.element_count();
  report.min_radius_ratio_before = worst_radius_ratio(before, options, threads);
  report.min_radius_ratio_after = worst_radius_ratio(after, options, threads);
  report.grains_before = grain_statistics(before, threads);
  report.grains_after = grain_statistics(after, threads);
  // Volumes exactly, by a rule of higher degree than that of the points.
  const auto old_volumes = mesh::grain_volumes(before.mesh, threads);
  const auto new_volumes = mesh::grain_volumes(after.mesh, threads);
  if (old_volumes.size() != new_volumes.size() || old_volumes.empty())
    throw core::InternalError("remeshing changed the number of grains");
  for (std::size_t g = 0; g < old_volumes.size(); ++g) {
    set_volume(report.grains_before[g], old_volumes[g]);
    set_volume(report.grains_after[g], new_volumes[g]);
  }
  report.before = body(report.grains_before);
  report.after = body(report.grains_after);

  const Extent volumes =
      extent(report, [](auto& a, auto& b) { return relative(a.volume, b.volume); });
  const Extent turns = extent(report, rotation);
  const Extent spreads = extent(report, [](auto& a, auto& b) { return b.spread - a.spread; });
  const Extent g = extent(report, [](auto& a, auto& b) { return relative(a.g.mean, b.g.mean); });
  report.max_grain_volume_change = volumes.worst;
  report.rms_grain_volume_change = volumes.rms;
  report.max_mean_rotation = turns.worst;
  report.mean_mean_rotation = turns.mean;
  report.max_spread_change = spreads.worst;
  report.max_g_change = g.worst;

  Limits limits(report.strain);
  limits.check(volumes, options.max_grain_volume_change, "max_grain_volume_change", "volume", 100,
               "%");
  limits.check(turns, options.max_grain_rotation, "max_grain_rotation", "mean orientation", 1,
               "degrees");
  limits.check(spreads, options.max_grain_spread_change, "max_grain_spread_change", "spread", 1,
               "degrees");
  limits.check(g, options.max_grain_g_change, "max_grain_g_change", "mean g", 100, "%");
  return limits.beyond();
}

}  // namespace polyslip::remap
