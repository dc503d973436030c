// The frame of sizes of bodies of known stretch.

#include "remap/size_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "remap/remesh.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::remap {
namespace {

using core::Vec3;

const Vec3 size(1.5, 1, 1);

mesh::Mesh stretched(const Vec3& stretch) {
  mesh::Mesh mesh = tests::box_mesh({3, 2, 2}, size);
  for (Vec3& x : mesh.nodes) x = x.cwiseProduct(stretch) + Vec3(3, -1, 2);
  return mesh;
}

TEST(SizeFrame, TakesTheShareOfEachAxis) {
  const double strain = 1.4;
  const Vec3 stretch(std::exp(strain), 1, std::exp(-strain));
  const Vec3 extent = size.cwiseProduct(stretch);
  EXPECT_LT((size_scale(size, extent, {1, 1}) - stretch.cwiseInverse()).norm(), 1e-14);
  EXPECT_LT(
      (size_scale(size, extent, {1, 0.5}) - Vec3(std::exp(-0.5 * strain), 1, std::exp(strain)))
          .norm(),
      1e-14);
  EXPECT_LT((size_scale(size, extent, {0.25, 0}) - Vec3(1, 1, std::exp(0.25 * strain))).norm(),
            1e-14);
  EXPECT_EQ(size_scale(size, size, {}), Vec3::Ones());  // the first mesh
}

TEST(SizeFrame, OfPartsIsThatOfTheMesh) {
  const mesh::Mesh first = stretched(Vec3::Ones()), now = stretched({2, 0.9, 0.6});
  const std::span<const Vec3> from(first.nodes), to(now.nodes);
  const std::size_t cut = from.size() / 3;
  const std::vector<PartBoxes> parts{part_boxes(from.first(cut), to.first(cut)), part_boxes({}, {}),
                                     part_boxes(from.subspan(cut), to.subspan(cut))};
  const RemeshingOptions options;
  EXPECT_LT((size_scale(parts, options.shares()) - meshing_scale(now, options)).norm(), 1e-14);
}

/// Regular elements of a mesh made in the frame keep their radius ratio there, and the half of a
/// later lengthening that a new mesh would not follow shows as wear.
TEST(SizeFrame, ShowsWhatANewMeshWouldUndo) {
  const RemeshingOptions options;
  const auto worst = [&](double strain) {
    const mesh::Mesh mesh = stretched({std::exp(strain), 1, std::exp(-strain)});
    const core::Mat3 frame = meshing_scale(mesh, options).asDiagonal();
    return measure_wear(mesh.tetrahedra, mesh.nodes, {}, frame, {}, 1).worst_radius_ratio;
  };
  const mesh::Mesh half = stretched({std::exp(0.2), 1, 1});
  EXPECT_NEAR(worst(0.4), mesh::quality(half).min_radius_ratio, 1e-12);
  EXPECT_LT(worst(0.4), worst(0));
}

TEST(SizeFrame, NeedsABody) {
  EXPECT_THROW(size_scale(size, {1, 0, 1}, {}), core::InternalError);
  EXPECT_THROW(size_scale({}, {}), core::InternalError);
  const std::vector<PartBoxes> none{part_boxes({}, {})};
  EXPECT_THROW(size_scale(none, {}), core::InternalError);
}

}  // namespace
}  // namespace polyslip::remap
