#include "material/point_driver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace polyslip::material {

namespace {

/// Index of `component` of `point` in an array [block][components][lane].
std::size_t lane_index(int point, int component, int components) {
  return (static_cast<std::size_t>(point / lanes) * static_cast<std::size_t>(components) +
          static_cast<std::size_t>(component)) *
             lanes +
         static_cast<std::size_t>(point % lanes);
}

}  // namespace

core::Mat3 exponential(const core::Mat3& a) {
  const int squarings =
      std::max(0, static_cast<int>(std::ceil(std::log2(std::max(a.norm(), 1e-300)))) + 3);
  const core::Mat3 x = a * std::ldexp(1.0, -squarings);
  core::Mat3 sum = core::Mat3::Identity();
  for (int j = 12; j >= 1; --j) sum = core::Mat3::Identity() + x * sum / j;
  for (int k = 0; k < squarings; ++k) sum = (sum * sum).eval();
  return sum;
}

std::vector<core::Quaternion> spread_orientations(int count) {
  const double phi = std::numbers::sqrt2;
  const double psi = 1.533751168755204288118041;  // root of psi^4 = psi + 4
  std::vector<core::Quaternion> orientations;
  for (int i = 0; i < count; ++i) {
    const double s = i + 0.5, t = s / count;
    const double alpha = 2 * std::numbers::pi * s / phi, beta = 2 * std::numbers::pi * s / psi;
    const double r = std::sqrt(t), rest = std::sqrt(1 - t);
    orientations.emplace_back(r * std::sin(alpha), r * std::cos(alpha), rest * std::sin(beta),
                              rest * std::cos(beta));
  }
  return orientations;
}

PointDriver::PointDriver(const CrystalLaw& law, std::span<const core::Quaternion> orientations)
    : law_(&law),
      count_(static_cast<int>(orientations.size())),
      blocks_((count_ + lanes - 1) / lanes) {
  if (count_ == 0) throw core::InternalError("PointDriver: no orientations");
  const int components = law.layout().size();
  const auto points = static_cast<std::size_t>(blocks_) * lanes;
  old_.resize(points * static_cast<std::size_t>(components));
  new_.resize(old_.size());
  stress_.resize(points * 6);
  new_stress_.resize(points * 6);
  gradient_.resize(points * 9);
  status_.resize(points);
  std::vector<double> state(static_cast<std::size_t>(components));
  for (int point = 0; point < blocks_ * lanes; ++point) {
    const auto source = static_cast<std::size_t>(std::min(point, count_ - 1));
    law.initial_state(orientations[source], state.data());
    for (int i = 0; i < components; ++i) {
      old_[lane_index(point, i, components)] = state[static_cast<std::size_t>(i)];
    }
  }
}

int PointDriver::advance(const core::Mat3& velocity_gradient, double time_step) {
  return deform(exponential(velocity_gradient * time_step), time_step);
}

int PointDriver::deform(const core::Mat3& relative_gradient, double time_step) {
  for (int point = 0; point < blocks_ * lanes; ++point) {
    for (int i = 0; i < 9; ++i)
      gradient_[lane_index(point, i, 9)] = relative_gradient(i / 3, i % 3);
  }
  PointBlocks blocks;
  blocks.n_blocks = blocks_;
  blocks.time_step = time_step;
  blocks.relative_gradient = gradient_.data();
  blocks.state_old = old_.data();
  blocks.state_new = new_.data();
  blocks.stress = new_stress_.data();
  blocks.status = status_.data();
  law_->update(blocks);
  const auto failed = static_cast<int>(
      std::count_if(status_.begin(), status_.begin() + count_,
                    [](PointStatus status) { return status != PointStatus::converged; }));
  if (failed == 0) {
    old_.swap(new_);
    stress_.swap(new_stress_);
  }
  return failed;
}

core::Vec6 PointDriver::mean_stress() const {
  core::Vec6 sum = core::Vec6::Zero();
  for (int point = 0; point < count_; ++point) sum += stress(point);
  return sum / count_;
}

core::Vec6 PointDriver::stress(int point) const {
  core::Vec6 result;
  for (int i = 0; i < 6; ++i) result[i] = stress_[lane_index(point, i, 6)];
  return result;
}

core::Quaternion PointDriver::orientation(int point) const {
  const int at = law_->layout().offset("orientation");
  return {state(point, at), state(point, at + 1), state(point, at + 2), state(point, at + 3)};
}

double PointDriver::state(int point, int component) const {
  return old_[lane_index(point, component, law_->layout().size())];
}

}  // namespace polyslip::material
