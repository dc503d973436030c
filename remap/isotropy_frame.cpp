#include "remap/isotropy_frame.hpp"

#include <Eigen/LU>

#include "core/error.hpp"

namespace polyslip::remap {
namespace {

using core::Mat3;
using core::Vec3;

/// FrameMoments as vectors and matrices.
struct Moments {
  std::int64_t nodes = 0;
  Vec3 initial = Vec3::Zero(), current = Vec3::Zero();
  Mat3 cross = Mat3::Zero(), own = Mat3::Zero();
};

Moments unpacked(const FrameMoments& m) {
  return {m.nodes, Vec3(m.initial.data()), Vec3(m.current.data()), Mat3(m.cross.data()),
          Mat3(m.own.data())};
}

FrameMoments packed(const Moments& m) {
  FrameMoments p;
  p.nodes = m.nodes;
  Eigen::Map<Vec3>(p.initial.data()) = m.initial;
  Eigen::Map<Vec3>(p.current.data()) = m.current;
  Eigen::Map<Mat3>(p.cross.data()) = m.cross;
  Eigen::Map<Mat3>(p.own.data()) = m.own;
  return p;
}

/// Adds a part to others: moments about the mean of both (T. F. Chan, G. H. Golub, R. J. LeVeque,
/// The American Statistician 37 (1983) 242-247, eq. 2.1), without the cancellation of sums about
/// the origin.
void add(const Moments& part, Moments& sum) {
  if (part.nodes == 0) return;
  const auto all = static_cast<double>(sum.nodes + part.nodes);
  const double share = static_cast<double>(part.nodes) / all;
  const double weight = static_cast<double>(sum.nodes) * share;
  const Vec3 from = part.current - sum.current, to = part.initial - sum.initial;
  sum.cross += part.cross + weight * to * from.transpose();
  sum.own += part.own + weight * from * from.transpose();
  sum.initial += share * to;
  sum.current += share * from;
  sum.nodes += part.nodes;
}

}  // namespace

FrameMoments frame_moments(std::span<const Vec3> initial, std::span<const Vec3> current) {
  if (initial.size() != current.size())
    throw core::InternalError("frame_moments: positions of different nodes");
  Moments m;
  if (current.empty()) return packed(m);
  m.nodes = static_cast<std::int64_t>(current.size());
  for (std::size_t n = 0; n < current.size(); ++n) {
    m.initial += initial[n];
    m.current += current[n];
  }
  m.initial /= static_cast<double>(m.nodes);
  m.current /= static_cast<double>(m.nodes);
  for (std::size_t n = 0; n < current.size(); ++n) {
    const Vec3 from = current[n] - m.current;
    m.cross += (initial[n] - m.initial) * from.transpose();
    m.own += from * from.transpose();
  }
  return packed(m);
}

Mat3 isotropy_frame(std::span<const FrameMoments> parts) {
  Moments body;
  for (const FrameMoments& part : parts) add(unpacked(part), body);
  const Mat3 frame = body.cross * body.own.inverse();
  if (body.nodes == 0 || !frame.allFinite() || !(frame.determinant() > 0))
    throw core::InternalError("isotropy_frame: the nodes do not span a body");
  return frame;
}

Mat3 isotropy_frame(std::span<const Vec3> initial, std::span<const Vec3> current) {
  const FrameMoments body = frame_moments(initial, current);
  return isotropy_frame({&body, 1});
}

Mat3 size_frame(const Vec3& scale, const Mat3& made) { return scale.asDiagonal() * made.inverse(); }

}  // namespace polyslip::remap
