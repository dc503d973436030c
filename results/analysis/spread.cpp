#include "results/analysis/spread.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/rotation.hpp"

namespace polyslip::results::analysis {
namespace {

using core::Quaternion;
using core::Vec3;

constexpr double settled = 1e-10;  // rad
constexpr int settling_rounds = 20;

std::vector<Sample> by_grain(const RunSample& s) {
  std::vector<Sample> grains(static_cast<std::size_t>(s.grains()));
  for (std::size_t i = 0; i < s.sample.size(); ++i) {
    Sample& g = grains.at(static_cast<std::size_t>(s.grain[i]));
    g.orientations.push_back(s.sample.orientations[i]);
    g.weights.push_back(s.sample.weights[i]);
  }
  return grains;
}

GrainSpread measure(const Sample& grain, const Quaternion& reference) {
  GrainSpread g;
  g.elements = static_cast<long>(grain.size());
  g.mean = settled_mean(grain, reference);
  const auto vectors = disorientation_vectors(grain, g.mean);
  double square = 0;
  for (std::size_t i = 0; i < grain.size(); ++i) {
    const double angle = vectors[i].norm(), w = grain.weights[i];
    g.volume += w;
    g.spread += w * angle;
    square += w * angle * angle;
    g.largest = std::max(g.largest, angle);
  }
  g.spread /= g.volume;
  g.deviation = std::sqrt(std::max(0.0, square / g.volume - g.spread * g.spread));
  g.bimodality = bimodality(vectors, grain.weights);
  return g;
}

}  // namespace

Quaternion settled_mean(const Sample& sample, const Quaternion& reference) {
  Quaternion mean = reference;
  for (int round = 0; round < settling_rounds; ++round) {
    const Quaternion next =
        core::aligned_sign(core::mean_orientation(sample.orientations, mean, sample.weights), mean);
    const bool same = core::rotation_angle(next * mean.conjugate()) < settled;
    mean = next;
    if (same) break;
  }
  return mean;
}

std::vector<Vec3> disorientation_vectors(const Sample& sample, const Quaternion& mean) {
  std::vector<Vec3> vectors;
  vectors.reserve(sample.size());
  for (const Quaternion& q : sample.orientations) {
    const Quaternion turn = core::canonical_sign(core::nearest_variant(q, mean) * mean.conjugate());
    const double half_sine = turn.vec().norm();
    const double angle = core::rotation_angle(turn) * core::degrees_per_radian;
    vectors.push_back(half_sine > 0 ? Vec3(turn.vec() * (angle / half_sine)) : Vec3::Zero());
  }
  return vectors;
}

double bimodality(const std::vector<Vec3>& vectors, const std::vector<double>& weights) {
  double total = 0;
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    total += weights[i];
    mean += weights[i] * vectors[i];
  }
  mean /= total;
  core::Mat3 moment = core::Mat3::Zero();
  for (std::size_t i = 0; i < vectors.size(); ++i)
    moment += weights[i] / total * (vectors[i] - mean) * (vectors[i] - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<core::Mat3> solver(moment);
  const double variance = solver.eigenvalues()[2];
  if (!(variance > 1e-16)) return 0;
  const Vec3 axis = solver.eigenvectors().col(2);
  double third = 0, fourth = 0;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const double x = axis.dot(vectors[i] - mean) / std::sqrt(variance);
    third += weights[i] / total * x * x * x;
    fourth += weights[i] / total * x * x * x * x;
  }
  return (third * third + 1) / fourth;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw core::InternalError("correlation: lists of unequal lengths");
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  if (x.size() < 2 || !(xx > 0) || !(yy > 0)) return std::numeric_limits<double>::quiet_NaN();
  return xy / std::sqrt(xx * yy);
}

std::vector<GrainSpread> grain_spreads(const RunSample& sample,
                                       const std::vector<GrainSpread>& before,
                                       const std::vector<GrainSpread>& first) {
  const auto grains = by_grain(sample);
  std::vector<GrainSpread> spreads;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (grains[i].size() == 0)
      throw core::InternalError("grain " + std::to_string(i + 1) + " has no element");
    const Quaternion reference =
        i < before.size() ? before[i].mean : core::fundamental_variant(grains[i].orientations[0]);
    spreads.push_back(measure(grains[i], reference));
    GrainSpread& g = spreads.back();
    if (i >= before.size())  // the first state
      g.mean = core::fundamental_variant(g.mean);
    if (i < first.size())
      g.rotation =
          core::rotation_angle(g.mean * first[i].mean.conjugate()) * core::degrees_per_radian;
  }
  return spreads;
}

}  // namespace polyslip::results::analysis
