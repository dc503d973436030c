#include "remap/size_frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/error.hpp"

namespace polyslip::remap {
namespace {

using core::Vec3;
using Box = Eigen::AlignedBox3d;

Box box_of(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& x : points) box.extend(x);
  return box;
}

std::array<double, 3> packed(const Vec3& x) { return {x[0], x[1], x[2]}; }

Box unpacked(const std::array<double, 3>& low, const std::array<double, 3>& high) {
  return {Vec3(low.data()), Vec3(high.data())};
}

}  // namespace

PartBoxes part_boxes(std::span<const Vec3> initial, std::span<const Vec3> current) {
  if (initial.size() != current.size())
    throw core::InternalError("part_boxes: positions of different nodes");
  const Box from = box_of(initial), to = box_of(current);
  return {packed(from.min()), packed(from.max()), packed(to.min()), packed(to.max())};
}

Vec3 size_scale(const Vec3& initial_extent, const Vec3& extent, const SizeShares& shares) {
  const Vec3 stretch = initial_extent.cwiseQuotient(extent);
  if (!(extent.minCoeff() > 0) || !stretch.allFinite() || !(stretch.minCoeff() > 0))
    throw core::InternalError("size_scale: the nodes do not span a body");
  Vec3 scale;
  for (int a = 0; a < 3; ++a)
    scale[a] = std::pow(stretch[a], stretch[a] > 1 ? shares.shortening : shares.lengthening);
  return scale;
}

Vec3 size_scale(std::span<const PartBoxes> parts, const SizeShares& shares) {
  Box initial, current;
  for (const PartBoxes& p : parts) {
    initial.extend(unpacked(p.initial_low, p.initial_high));
    current.extend(unpacked(p.low, p.high));
  }
  return size_scale(initial.sizes(), current.sizes(), shares);
}

}  // namespace polyslip::remap
