// Measures of wear: blind to homogeneous motions, known values for known distortions.

#include "remap/wear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::remap {
namespace {

using core::Mat3;
using core::Vec3;

mesh::Mesh box() { return tests::box_mesh({3, 2, 2}, Vec3(1.5, 1, 1)); }

std::vector<Vec3> moved(const std::vector<Vec3>& points, const Mat3& f, const Vec3& shift) {
  std::vector<Vec3> result;
  for (const Vec3& x : points) result.push_back(f * x + shift);
  return result;
}

Mat3 gradient() {
  Mat3 f;
  f << 2.1, 0.4, -0.2, 0.1, 0.9, 0.3, 0, 0.2, 0.6;
  return f;
}

Wear measure(const mesh::Mesh& mesh, const std::vector<Vec3>& now,
             const std::vector<Vec3>& rates = {}) {
  return measure_wear(mesh.tetrahedra, now, rates, isotropy_frame(mesh.nodes, now), {}, 2);
}

TEST(IsotropyFrame, UndoesAHomogeneousMotion) {
  const mesh::Mesh mesh = box();
  const auto now = moved(mesh.nodes, gradient(), {3, -1, 2});
  EXPECT_LT((isotropy_frame(mesh.nodes, now) * gradient() - Mat3::Identity()).norm(), 1e-12);
}

TEST(IsotropyFrame, NeedsABody) {
  const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_THROW(isotropy_frame(flat, flat), core::InternalError);
  EXPECT_THROW(isotropy_frame({}, {}), core::InternalError);
}

/// The motion is not homogeneous, so that the fit weighs all nodes; one part is empty, as that of a
/// rank without nodes.
TEST(IsotropyFrame, OfPartsIsThatOfTheWhole) {
  const mesh::Mesh mesh = box();
  auto now = moved(mesh.nodes, gradient(), {300, -100, 200});
  for (Vec3& x : now) x += 0.1 * Vec3(std::sin(3 * x.y()), std::cos(2 * x.z()), std::sin(x.x()));
  const std::span<const Vec3> from(mesh.nodes), to(now);
  const std::size_t cut = from.size() / 3;
  const std::vector<FrameMoments> parts{frame_moments(from.first(cut), to.first(cut)),
                                        frame_moments({}, {}),
                                        frame_moments(from.subspan(cut), to.subspan(cut))};
  EXPECT_LT((isotropy_frame(parts) - isotropy_frame(mesh.nodes, now)).norm(), 1e-12);
}

/// A mesh made at some strain in the frame scaled by `scale` has its radius ratios there, and keeps
/// them in whatever homogeneous motion follows, shear too.
TEST(SizeFrame, IsThatOfTheMeshFromWhereItWasMade) {
  const mesh::Mesh mesh = box();
  Mat3 before;
  before << 2, 0, 0.3, 0, 1, 0, 0, 0, 0.5;
  const auto made = moved(mesh.nodes, before, Vec3::Zero());
  const auto now = moved(made, gradient(), {3, -1, 2});
  const Vec3 scale(0.7, 1, 2);
  const Mat3 sizes = size_frame(scale, isotropy_frame(mesh.nodes, made));
  const auto worst = [&](const std::vector<Vec3>& x, const Mat3& frame) {
    return measure_wear(mesh.tetrahedra, x, {}, frame, {}, 1).worst_radius_ratio;
  };
  const double expected = worst(made, scale.asDiagonal());
  EXPECT_LT((sizes * isotropy_frame(mesh.nodes, made) - Mat3(scale.asDiagonal())).norm(), 1e-12);
  EXPECT_NEAR(worst(now, sizes * isotropy_frame(mesh.nodes, now)), expected, 1e-10);
  EXPECT_GT(std::abs(worst(now, isotropy_frame(mesh.nodes, now)) - expected), 0.01);
}

TEST(Wear, OfPartsIsThatOfTheWhole) {
  const mesh::Mesh mesh = box();
  auto now = mesh.nodes;
  const auto& t = mesh.tetrahedra[5];
  now[t[4]] += 0.1 * (now[t[0]] - now[t[1]]);
  std::vector<Vec3> rates(now.size(), Vec3::Zero());
  rates[t[0]] = 40 * (now[t[1]] - now[t[0]]);
  WearOptions options;
  options.poor_radius_ratio = 0.8;
  const Mat3 frame = gradient().inverse();
  const auto part = [&](std::size_t first, std::size_t count) {
    return measure_part(std::span(mesh.tetrahedra).subspan(first, count), now, rates, frame,
                        options, 1);
  };
  const std::vector<PartWear> parts{part(0, 3), part(3, 0), part(3, mesh.tetrahedra.size() - 3)};
  const Wear whole = measure_wear(mesh.tetrahedra, now, rates, frame, options, 1);
  const Wear sum = whole_wear(parts);
  EXPECT_EQ(sum.worst_radius_ratio, whole.worst_radius_ratio);
  EXPECT_EQ(sum.worst_jacobian, whole.worst_jacobian);
  EXPECT_EQ(sum.inversion_strain, whole.inversion_strain);
  EXPECT_LT(whole.inversion_strain, 1);
  EXPECT_EQ(sum.poor_share, whole.poor_share);
  EXPECT_GT(whole.poor_share, 0);
}

TEST(Wear, APartThatIsNotANumberShowsInTheWhole) {
  PartWear bad;
  bad.worst_jacobian = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(whole_wear(std::vector<PartWear>{{}, bad, {}}).worst_jacobian));
}

TEST(Wear, DoesNotSeeAHomogeneousMotion) {
  const mesh::Mesh mesh = box();
  const Wear at_rest = measure(mesh, mesh.nodes);
  EXPECT_NEAR(at_rest.worst_radius_ratio, mesh::quality(mesh).min_radius_ratio, 1e-12);
  EXPECT_NEAR(at_rest.worst_jacobian, 1, 1e-12);  // straight elements
  EXPECT_EQ(at_rest.poor_share, 0);
  const Wear after = measure(mesh, moved(mesh.nodes, gradient(), {3, -1, 2}));
  EXPECT_NEAR(after.worst_radius_ratio, at_rest.worst_radius_ratio, 1e-10);
  EXPECT_NEAR(after.worst_jacobian, 1, 1e-10);
  EXPECT_FALSE(worn(at_rest, after, {}));
}

/// With the mid node of the edge from corner 0 to corner 1 moved by t of the edge towards corner 0,
/// dx/ds at corner 0 falls to 1 - 4 t of the edge (N_mid = 4 s (1 - s)), and so does det J there.
TEST(Wear, SeesAMovedMidNode) {
  const mesh::Mesh mesh = box();
  auto now = mesh.nodes;
  const auto& t = mesh.tetrahedra[5];
  now[t[4]] += 0.2 * (now[t[0]] - now[t[1]]);
  const Wear wear = measure_wear(mesh.tetrahedra, now, {}, Mat3::Identity(), {}, 1);
  EXPECT_GT(wear.worst_jacobian, 0);
  EXPECT_LT(wear.worst_jacobian, 0.25);  // 1 - 4 * 0.2, over a mean that changes little
  EXPECT_EQ(wear.worst_radius_ratio, measure(mesh, mesh.nodes).worst_radius_ratio);
  const auto reason = worn(measure(mesh, mesh.nodes), wear, {});
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("worst scaled Jacobian 0."), std::string::npos) << *reason;
}

/// A corner that moves towards the opposite facet of its element at the rate of its height over L
/// inverts it after a strain of L, whatever the homogeneous motion.
TEST(Wear, ForeseesTheInversion) {
  const mesh::Mesh mesh = box();
  const auto now = moved(mesh.nodes, gradient(), {0, 0, 0});
  const auto& t = mesh.tetrahedra[7];
  std::vector<Vec3> rates(now.size(), Vec3::Zero());
  constexpr double strain = 0.02;
  const Vec3 way = (now[t[1]] + now[t[2]] + now[t[3]]) / 3 - now[t[0]];
  // Corner and the mid nodes on its edges, so that elements stay straight.
  rates[t[0]] = way / strain;
  for (const auto& other : mesh.tetrahedra)
    for (std::size_t i = 0; i < 6; ++i) {
      const auto [a, b] = mesh::tetrahedron_edges[i];
      if (other[a] == t[0] || other[b] == t[0]) rates[other[4 + i]] = way / strain / 2;
    }
  const Wear wear = measure(mesh, now, rates);
  EXPECT_GT(wear.inversion_strain, 0.5 * strain);  // a neighbour may be first
  EXPECT_LT(wear.inversion_strain, strain * (1 + 1e-6));
  EXPECT_TRUE(worn(measure(mesh, now), wear, {}));
  WearOptions never;
  never.inversion_strain = 0;
  EXPECT_FALSE(worn(measure(mesh, now), wear, never));
}

TEST(Wear, CountsPoorElements) {
  const mesh::Mesh mesh = box();
  WearOptions options;
  options.poor_radius_ratio = 1;
  const Wear all = measure_wear(mesh.tetrahedra, mesh.nodes, {}, Mat3::Identity(), options, 1);
  EXPECT_EQ(all.poor_share, 1);
  Wear fresh = all;
  fresh.poor_share = 0.9;
  const auto reason = worn(fresh, all, options);
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("100.00 % of the elements"), std::string::npos) << *reason;
  options.poor_share_increase = 0.2;
  EXPECT_FALSE(worn(fresh, all, options));
}

TEST(Wear, WornIsWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Wear fresh{0.3, 0, 0.8, 1};
  EXPECT_FALSE(worn(fresh, fresh, {}));
  EXPECT_TRUE(worn(fresh, {nan, 0, 0.8, 1}, {}));
  EXPECT_TRUE(worn(fresh, {0.3, nan, 0.8, 1}, {}));
  EXPECT_TRUE(worn(fresh, {0.3, 0, nan, 1}, {}));
  EXPECT_TRUE(worn(fresh, {0.3, 0, 0.8, nan}, {}));
}

}  // namespace
}  // namespace polyslip::remap
