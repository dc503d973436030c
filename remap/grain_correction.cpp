#include "remap/grain_correction.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.hpp"
#include "core/rotation.hpp"
#include "remap/donor_average.hpp"

namespace polyslip::remap {
namespace {

using core::Quaternion;
using core::Vec3;

/// Points of a grain, their volumes and the values of a field there.
struct Points {
  std::size_t first = 0, count = 0;
  std::span<const double> volumes;
};

class GrainPoints {
 public:
  explicit GrainPoints(const mesh::Snapshot& s)
      : cells_(s.mesh.tetrahedron_cell),
        points_(static_cast<std::size_t>(s.quadrature_points)),
        volumes_(point_volumes(s)) {}

  Points of(int grain) const {
    const auto [begin, end] = std::equal_range(cells_.begin(), cells_.end(), grain);
    const auto first = static_cast<std::size_t>(begin - cells_.begin()) * points_;
    const auto count = static_cast<std::size_t>(end - begin) * points_;
    return {first, count, std::span<const double>(volumes_).subspan(first, count)};
  }

 private:
  const std::vector<int>& cells_;
  std::size_t points_;
  std::vector<double> volumes_;
};

std::vector<Quaternion> orientations(const mesh::Field& field, const Points& points) {
  std::vector<Quaternion> all;
  all.reserve(points.count);
  for (std::size_t i = points.first; i < points.first + points.count; ++i) {
    const double* q = &field.values[4 * i];
    all.emplace_back(q[0], q[1], q[2], q[3]);
  }
  return all;
}

/// Rotation vector of q, the short way round.
Vec3 rotation_vector(const Quaternion& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const double sine = q.vec().norm();
  if (sine == 0) return Vec3::Zero();
  return 2 * sign * std::atan2(sine, std::abs(q.w())) / sine * q.vec();
}

/// Mean angle from the mean orientation [rad], weighted by volume.
double spread(const std::vector<Quaternion>& all, const Quaternion& mean, const Points& points) {
  double sum = 0, volume = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    sum += points.volumes[i] * rotation_vector(mean.conjugate() * all[i]).norm();
    volume += points.volumes[i];
  }
  return sum / volume;
}

void correct_orientations(const mesh::Field& old_field, const Points& from, mesh::Field& field,
                          const Points& to) {
  if (from.count == 0 || to.count == 0) return;
  const auto before = orientations(old_field, from);
  const Quaternion wanted = core::mean_rotation(before, from.volumes);
  const double wanted_spread = spread(before, wanted, from);
  auto now = orientations(field, to);
  constexpr int rounds = 3;       // each leaves the square of what was left
  constexpr double least = 1e-9;  // rad; below it there is nothing to scale
  for (int round = 0; round < rounds; ++round) {
    const Quaternion mean = core::mean_rotation(now, to.volumes);
    const double have = spread(now, mean, to);
    const double factor = have > least ? wanted_spread / have : 1;
    for (Quaternion& q : now) {
      const Vec3 deviation = rotation_vector(mean.conjugate() * q);
      q = core::aligned_sign(wanted * core::exp_axial(factor * deviation), q);
    }
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    double* q = &field.values[4 * (to.first + i)];
    const Quaternion unit = now[i].normalized();
    q[0] = unit.w();
    q[1] = unit.x();
    q[2] = unit.y();
    q[3] = unit.z();
  }
}

struct Range {
  double mean = 0, min = 0, max = 0;
};

Range range_of(const mesh::Field& field, const Points& points, std::size_t component) {
  const auto n = static_cast<std::size_t>(field.components);
  Range r;
  double volume = 0;
  r.min = r.max = field.values[points.first * n + component];
  for (std::size_t i = 0; i < points.count; ++i) {
    const double value = field.values[(points.first + i) * n + component];
    r.mean += points.volumes[i] * value;
    volume += points.volumes[i];
    r.min = std::min(r.min, value);
    r.max = std::max(r.max, value);
  }
  r.mean /= volume;
  return r;
}

void correct_scalars(const mesh::Field& old_field, const Points& from, mesh::Field& field,
                     const Points& to) {
  if (from.count == 0 || to.count == 0) return;
  const auto n = static_cast<std::size_t>(field.components);
  for (std::size_t c = 0; c < n; ++c) {
    const Range wanted = range_of(old_field, from, c);
    const double have = range_of(field, to, c).mean;
    if (have == 0) continue;
    for (std::size_t i = 0; i < to.count; ++i) {
      double& value = field.values[(to.first + i) * n + c];
      value = std::clamp(value * (wanted.mean / have), wanted.min, wanted.max);
    }
  }
}

}  // namespace

void correct_grains(const mesh::Snapshot& old, mesh::Snapshot& fresh, int threads) {
  const GrainPoints from(old), to(fresh);
  for (mesh::Field& field : fresh.fields) {
    if (field.location != mesh::Location::quadrature_point) continue;
    const bool turns = field.transport == core::Transport::orientation_average;
    if (!turns && field.transport != core::Transport::element_average) continue;
    const mesh::Field& before = *old.find(field.name, field.location);
    core::parallel_for(threads, old.mesh.topology.cell_faces.size(), [&](std::size_t g) {
      const Points a = from.of(static_cast<int>(g)), b = to.of(static_cast<int>(g));
      (turns ? correct_orientations : correct_scalars)(before, a, field, b);
    });
  }
}

}  // namespace polyslip::remap
