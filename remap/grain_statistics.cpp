#include "remap/grain_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"
#include "core/rotation.hpp"
#include "core/tensor.hpp"
#include "remap/donor_average.hpp"

namespace polyslip::remap {
namespace {

using core::Quaternion;
using mesh::Field;
using mesh::Location;

class Gatherer {
 public:
  explicit Gatherer(const mesh::Snapshot& snapshot)
      : points_(static_cast<std::size_t>(snapshot.quadrature_points)),
        cells_(snapshot.mesh.tetrahedron_cell),
        volumes_(point_volumes(snapshot)),
        orientation_(snapshot.find("orientation", Location::quadrature_point)),
        g_(snapshot.find("g", Location::quadrature_point)),
        slip_(snapshot.find("slip", Location::quadrature_point)),
        elastic_strain_(snapshot.find("elastic_strain", Location::quadrature_point)),
        stress_(snapshot.find("cauchy_stress", Location::quadrature_point)),
        volume_(snapshot.find("volume", Location::element)),
        reference_volume_(snapshot.find("reference_volume", Location::element)) {}

  GrainStatistics operator()(int grain) const {
    const auto [begin, end] = std::equal_range(cells_.begin(), cells_.end(), grain);
    const std::size_t first = static_cast<std::size_t>(begin - cells_.begin()) * points_;
    const std::size_t last = static_cast<std::size_t>(end - cells_.begin()) * points_;
    GrainStatistics s;
    for (std::size_t i = first; i < last; ++i) s.volume += volumes_[i];
    s.volume_at_zero_pressure = s.volume * reference_share(begin, end);
    if (g_) s.g = statistics(*g_, first, last, s.volume);
    if (slip_) s.slip = statistics(*slip_, first, last, s.volume);
    if (!orientation_ || first == last) return s;
    add_orientations(s, first, last);
    if (elastic_strain_ && stress_)
      for (std::size_t i = first; i < last; ++i) s.elastic_energy += volumes_[i] * energy(i);
    return s;
  }

 private:
  /// Of the elements' volumes at zero pressure in their volumes.
  double reference_share(std::vector<int>::const_iterator begin,
                         std::vector<int>::const_iterator end) const {
    if (!volume_ || !reference_volume_ || begin == end) return 1;
    const auto sum = [&](const Field& field) {
      return std::accumulate(field.values.begin() + (begin - cells_.begin()),
                             field.values.begin() + (end - cells_.begin()), 0.0);
    };
    return sum(*reference_volume_) / sum(*volume_);
  }

  /// Components are averaged: a field of twelve equal ones is like a field of one.
  FieldStatistics statistics(const Field& field, std::size_t first, std::size_t last,
                             double volume) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto n = static_cast<std::size_t>(field.components);
    FieldStatistics s{0, infinity, -infinity};
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t c = 0; c < n; ++c) {
        const double value = field.values[i * n + c];
        s.mean += volumes_[i] * value / (volume * static_cast<double>(n));
        s.min = std::min(s.min, value);
        s.max = std::max(s.max, value);
      }
    return s;
  }

  Quaternion at(std::size_t i) const {
    const double* q = &orientation_->values[4 * i];
    return {q[0], q[1], q[2], q[3]};
  }

  void add_orientations(GrainStatistics& s, std::size_t first, std::size_t last) const {
    std::vector<Quaternion> all;
    for (std::size_t i = first; i < last; ++i) all.push_back(at(i));
    s.orientation =
        core::mean_rotation(all, std::span<const double>(volumes_).subspan(first, last - first));
    for (std::size_t i = first; i < last; ++i)
      s.spread += volumes_[i] / s.volume * core::degrees_per_radian *
                  core::rotation_angle(s.orientation.conjugate() * at(i));
  }

  /// MPa
  double energy(std::size_t i) const {
    const double* t = &stress_->values[6 * i];
    core::Mat3 sigma;
    sigma << t[0], t[5], t[4], t[5], t[1], t[3], t[4], t[3], t[2];
    const core::Mat3 q = core::to_matrix(at(i));
    const core::Vec5 s = core::deviator5(q.transpose() * sigma * q);
    const Eigen::Map<const core::Vec5> e(&elastic_strain_->values[5 * i]);
    double density = s.dot(e) / 2;
    if (volume_ && reference_volume_) {
      const std::size_t element = i / points_;
      density += sigma.trace() / 6 *
                 std::log(volume_->values[element] / reference_volume_->values[element]);
    }
    return density;
  }

  std::size_t points_;
  const std::vector<int>& cells_;
  std::vector<double> volumes_;
  const Field *orientation_, *g_, *slip_, *elastic_strain_, *stress_, *volume_, *reference_volume_;
};

}  // namespace

std::vector<GrainStatistics> grain_statistics(const mesh::Snapshot& snapshot, int threads) {
  const Gatherer gather(snapshot);
  std::vector<GrainStatistics> grains(snapshot.mesh.topology.cell_faces.size());
  core::parallel_for(threads, grains.size(),
                     [&](std::size_t g) { grains[g] = gather(static_cast<int>(g)); });
  return grains;
}

}  // namespace polyslip::remap
