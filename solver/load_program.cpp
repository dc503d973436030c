#include "solver/load_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace polyslip::solver {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
/// Relative difference of path below which a target is reached: rounding, far below any step.
constexpr double rounding = 1e-12;

std::vector<LoadingStage> stages_of(const LoadingOptions& loading) {
  if (!loading.stages.empty()) return loading.stages;
  return {{loading.strain_rate, loading.final_strain, loading.final_time, loading.final_stress}};
}

int stretch_of(const LoadingOptions& loading) {
  if (loading.control != "constant-velocity") return 0;
  if (loading.type == "uniaxial-tension") return 1;
  if (loading.type == "uniaxial-compression" || loading.type == "plane-strain-compression")
    return -1;
  return 0;
}

}  // namespace

LoadProgram::LoadProgram(const LoadingOptions& loading)
    : stages_(stages_of(loading)), stretch_(stretch_of(loading)) {
  begin_stage(0, 0, 0);
  LoadProgram all = *this;
  while (!all.finished()) all.advance(all.stage_end_, false);
  planned_end_ = all.path0_;
}

void LoadProgram::begin_stage(double path, double time, double strain) {
  path0_ = path;
  time0_ = time;
  strain0_ = strain;
  if (finished()) {
    stage_end_ = path;
    return;
  }
  const LoadingStage& s = stages_[stage_];
  direction_ = s.strain_rate < 0 ? -1 : 1;
  stage_end_ = never;
  if (s.strain) {
    if (*s.strain != strain) direction_ = *s.strain > strain ? 1 : -1;
    stage_end_ = path + std::abs(*s.strain - strain);
  }
  if (s.time) {
    const double change = strain_change(std::max(*s.time - time, 0.0));
    stage_end_ = std::min(stage_end_, path + std::abs(change));
  }
  if (!s.strain && !s.time) stage_end_ = path + 10;
}

double LoadProgram::strain_change(double duration) const {
  const double rate = direction_ * std::abs(stages_[stage_].strain_rate);
  if (stretch_ == 0) return rate * duration;
  // h/h0 = exp(stretch e) changes at the rate `stretch rate`.
  const double height = std::exp(stretch_ * strain0_) + stretch_ * rate * duration;
  return height > 0 ? std::log(height) / stretch_ - strain0_ : direction_ * never;
}

double LoadProgram::strain(double path) const { return strain0_ + direction_ * (path - path0_); }

double LoadProgram::time(double path) const {
  const double rate = std::abs(stages_[std::min(stage_, stages_.size() - 1)].strain_rate);
  const double change = stretch_ == 0
                            ? path - path0_
                            : std::exp(stretch_ * strain0_) *
                                  std::abs(std::expm1(stretch_ * direction_ * (path - path0_)));
  return time0_ + change / rate;
}

std::optional<double> LoadProgram::stress_target() const {
  return finished() ? std::nullopt : stages_[stage_].stress;
}

bool LoadProgram::advance(double path, bool stress_met) {
  if (finished() || (!stress_met && path < stage_end_ * (1 - rounding))) return false;
  const double t = time(path);
  // What the deck says is meant to the last digit.
  const LoadingStage& s = stages_[stage_];
  double e = strain(path);
  if (!stress_met && s.strain && std::abs(*s.strain - e) <= 1e-12 * (1 + std::abs(e)))
    e = *s.strain;
  ++stage_;
  begin_stage(path, t, e);
  return true;
}

std::vector<double> LoadProgram::history() const {
  return {static_cast<double>(stage_), path0_, time0_, strain0_};
}

void LoadProgram::restore(const std::vector<double>& history) {
  if (history.size() != 4 || !(history[0] >= 0) ||
      !(history[0] <= static_cast<double>(stages_.size())))
    throw core::InternalError("LoadProgram: the stored stage is not one of this load");
  stage_ = static_cast<std::size_t>(history[0]);
  begin_stage(history[1], history[2], history[3]);
}

double von_mises(const std::array<double, 6>& s) {
  const double mean = (s[0] + s[1] + s[2]) / 3;
  double square = 0;
  for (std::size_t c = 0; c < 3; ++c)
    square += 1.5 * (s[c] - mean) * (s[c] - mean) + 3 * s[3 + c] * s[3 + c];
  return std::sqrt(square);
}

double load_stress(const LoadingOptions& loading, const std::array<double, 6>& stress) {
  const auto normal = static_cast<std::size_t>(loading.axis);
  if (loading.type == "uniaxial-tension") return stress[normal];
  if (loading.type == "uniaxial-compression" || loading.type == "plane-strain-compression")
    return -stress[normal];
  if (loading.type == "simple-shear")
    return stress[6 - static_cast<std::size_t>(loading.axis + loading.direction)];
  return von_mises(stress);
}

}  // namespace polyslip::solver
