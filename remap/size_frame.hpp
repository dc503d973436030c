#pragma once
// The frame of sizes: the one in which the elements of a mesh made now would be regular.

#include <array>
#include <span>

#include "core/types.hpp"

namespace polyslip::remap {

/// Bounding box of one part of a body's nodes (a rank's, say), at zero strain and now; without
/// nodes low > high. Plain numbers, to be sent as they are.
struct PartBoxes {
  std::array<double, 3> initial_low{}, initial_high{}, low{}, high{};  ///< length
};

/// Of nodes at `initial`, now at `current`. Throws InternalError for spans of different lengths.
PartBoxes part_boxes(std::span<const core::Vec3> initial, std::span<const core::Vec3> current);

/// What part of a change of the body's extent element sizes follow.
struct SizeShares {
  double shortening = 1, lengthening = 0.5;
};

/// Scale of the frame of sizes, x_sized = scale * x component by component: along each axis
/// (initial extent / extent)^share, with the one share where the body has become shorter and the
/// other where it has become longer. Throws InternalError for nodes in a plane, and for none.
core::Vec3 size_scale(const core::Vec3& initial_extent, const core::Vec3& extent,
                      const SizeShares& shares);
/// The same of a body in parts.
core::Vec3 size_scale(std::span<const PartBoxes> parts, const SizeShares& shares);

}  // namespace polyslip::remap
