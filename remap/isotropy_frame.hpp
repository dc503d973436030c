#pragma once
// The frame in which a deformed body has its first shape again, on average, and that of the sizes
// of a mesh's elements.

#include <array>
#include <cstdint>
#include <span>

#include "core/types.hpp"

namespace polyslip::remap {

/// First and second moments of one part of a body's nodes (a rank's, say), about the part's means.
/// Plain numbers, to be sent as they are; matrices by columns.
struct FrameMoments {
  std::int64_t nodes = 0;
  std::array<double, 3> initial{}, current{};  ///< means, length
  std::array<double, 9> cross{};               ///< sum of (initial - mean) (current - mean)^T
  std::array<double, 9> own{};                 ///< sum of (current - mean) (current - mean)^T
};

/// Of nodes at `initial`, now at `current`. Throws InternalError for spans of different lengths.
FrameMoments frame_moments(std::span<const core::Vec3> initial,
                           std::span<const core::Vec3> current);

/// The linear part A of the least-squares fit `initial = A current + b` over all nodes of all
/// parts: the inverse of the mean deformation gradient. The frame x_scaled = A x is the one scaled
/// back to isotropy, in which a homogeneous motion does nothing. Throws InternalError for nodes in
/// a plane, and for none.
core::Mat3 isotropy_frame(std::span<const FrameMoments> parts);
/// The same of a body in one part.
core::Mat3 isotropy_frame(std::span<const core::Vec3> initial, std::span<const core::Vec3> current);

/// What brings a frame scaled back to isotropy to the frame of sizes of a mesh that was made in
/// x_sized = scale * x when the isotropy frame was A_made x: diag(scale) A_made^-1. With it times
/// isotropy_frame(now) a homogeneous motion since then does nothing.
core::Mat3 size_frame(const core::Vec3& scale, const core::Mat3& made);

}  // namespace polyslip::remap
