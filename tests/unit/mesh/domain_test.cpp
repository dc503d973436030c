#include "mesh/domain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/error.hpp"
#include "core/random.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

Domain prism(int sides, double height, double volume) {
  std::vector<Plane> planes{{{0, 0, -1}, 0}, {{0, 0, 1}, height}};
  std::vector<std::string> names{"z0", "z1"};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    planes.push_back({{std::cos(angle), std::sin(angle), 0}, 1});
    names.push_back("side");
  }
  return convex_domain("cylinder", planes, names, volume);
}

void expect_closed(const Domain& d) {
  EXPECT_EQ(d.vertices.size() + d.faces.size(), d.edges.size() + 2);  // Euler
  for (const auto& face : d.faces) {
    EXPECT_NEAR(face.plane.normal.norm(), 1, 1e-15);
    ASSERT_GE(face.loop.size(), 3u);
    for (const int v : face.loop)
      EXPECT_NEAR(face.plane.normal.dot(d.vertices[v]), face.plane.offset, 1e-14 * d.size.norm());
    for (const Vec3& x : d.vertices)
      EXPECT_LE(face.plane.normal.dot(x), face.plane.offset + 1e-14 * d.size.norm());
  }
  Vec3 low = d.vertices[0], high = low;
  for (const Vec3& x : d.vertices) low = low.cwiseMin(x), high = high.cwiseMax(x);
  EXPECT_EQ(low, Vec3(0, 0, 0));
  EXPECT_EQ(high, d.size);
}

void expect_refused(const std::vector<Plane>& planes, const std::string& word) {
  try {
    const std::vector<std::string> names(planes.size(), "f");
    convex_domain("half-spaces", planes, names);
    FAIL() << "accepted; expected: " << word;
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

std::vector<Plane> cube_planes() {
  return {{{-1, 0, 0}, 0}, {{1, 0, 0}, 1},  {{0, -1, 0}, 0},
          {{0, 1, 0}, 1},  {{0, 0, -1}, 0}, {{0, 0, 1}, 1}};
}

TEST(Domain, ABoxHasItsFacesEdgesAndVolume) {
  const Domain box = box_domain({2, 3, 4});
  expect_closed(box);
  EXPECT_EQ(box.volume, 24);
  EXPECT_EQ(box.faces.size(), 6u);
  EXPECT_EQ(box.surface_names(), (std::vector<std::string>{"x0", "x1", "y0", "y1", "z0", "z1"}));
  EXPECT_THROW(box_domain({1, 0, 1}), core::InputError);
  EXPECT_THROW(box_domain({1, NAN, 1}), core::InputError);
}

TEST(Domain, APrismHasTheVolumeOfItsFormula) {
  for (const int sides : {3, 4, 7, 24}) {
    const Domain d = prism(sides, 2, 0);
    expect_closed(d);
    EXPECT_NEAR(d.volume / (2 * sides * std::tan(std::numbers::pi / sides)), 1, 1e-13);
    EXPECT_EQ(d.surface_names(), (std::vector<std::string>{"z0", "z1", "side"}));
    EXPECT_EQ(d.surface_of_face().back(), 2);
    EXPECT_NEAR(prism(sides, 2, 77).volume, 77, 1e-12 * 77);
  }
}

TEST(Domain, MoreThanThreePlanesMayMeetInAVertex) {
  std::vector<Plane> planes;
  for (int i = 0; i < 8; ++i)
    planes.push_back({{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}, 1});
  const Domain octahedron = convex_domain("half-spaces", planes, std::vector<std::string>(8, "f"));
  expect_closed(octahedron);
  EXPECT_EQ(octahedron.vertices.size(), 6u);
  EXPECT_NEAR(octahedron.volume, 4.0 / 3, 1e-14);
}

TEST(Domain, RefusesPlanesThatMakeNoBody) {
  auto planes = cube_planes();
  planes.pop_back();
  expect_refused(planes, "no end");
  planes = cube_planes();
  planes.push_back({{1, 1, 1}, 4});
  expect_refused(planes, "half-space 7");
  planes = cube_planes();
  planes.push_back({{1, 1, 1}, 3});  // touches a corner
  expect_refused(planes, "half-space 7");
  planes = cube_planes();
  planes.push_back({{2, 0, 0}, 1});
  expect_refused(planes, "direction of");
  planes = cube_planes();
  planes[3].normal.setZero();
  expect_refused(planes, "must not be zero");
  planes = cube_planes();
  planes[3].offset = NAN;
  expect_refused(planes, "half-space 4");
  planes = cube_planes();
  planes[1].offset = -1;
  expect_refused(planes, "enclose no body");
  expect_refused({}, "enclose no body");
}

TEST(Domain, PointsArePutOnPlanes) {
  const Plane x1{{1, 0, 0}, 2}, oblique{Vec3(1, 1, 0).normalized(), 2},
      other{Vec3(0, 1, 1).normalized(), 1};
  Vec3 x(1, 1, 1);
  put_on_planes(std::vector<Plane>{x1}, x);
  EXPECT_EQ(x, Vec3(2, 1, 1));
  const std::vector<Plane> all{oblique, x1, other, oblique};
  put_on_planes(all, x);
  EXPECT_EQ(x[0], 2);
  for (const Plane& p : all) EXPECT_NEAR(p.normal.dot(x), p.offset, 1e-15);
  EXPECT_EQ(free_directions(all).count, 0);
  const auto along = free_directions(std::vector<Plane>{oblique, other});
  ASSERT_EQ(along.count, 1);
  EXPECT_NEAR(along[0].dot(oblique.normal), 0, 1e-15);
  EXPECT_NEAR(along[0].dot(other.normal), 0, 1e-15);
  EXPECT_EQ(free_directions(std::vector<Plane>{x1})[0], Vec3(0, 1, 0));
  EXPECT_EQ(free_directions({}).count, 3);
  x = {5, 5, 7};
  put_on_planes(std::vector<Plane>{oblique}, x);
  EXPECT_NEAR(x[0], std::sqrt(2.0), 1e-15);
  EXPECT_EQ(x[2], 7);
}

/// Random points of the domain.
std::vector<Vec3> points_in(const Domain& d, int count) {
  core::Random random(7, core::Stream::seeds);
  std::vector<Vec3> points;
  while (static_cast<int>(points.size()) < count) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 p = Vec3(x, y, z).cwiseProduct(d.size);
    bool inside = true;
    for (const auto& f : d.faces) inside = inside && f.plane.normal.dot(p) < f.plane.offset;
    if (inside) points.push_back(p);
  }
  return points;
}

void expect_fills(const Tessellation& t) {
  t.check();
  double volume = 0;
  for (int c = 0; c < t.topology.cell_count(); ++c) volume += cell_volume(t, c);
  EXPECT_NEAR(volume / t.domain.volume, 1, 1e-12);
  std::set<int> touched;
  for (const auto& face : t.topology.faces)
    if (face.domain_face >= 0) touched.insert(face.domain_face);
  EXPECT_EQ(static_cast<int>(touched.size()), t.domain.face_count());
  // The corners of the domain stay.
  for (const Vec3& corner : t.domain.vertices) {
    double nearest = 1e9;
    for (const Vec3& x : t.vertices) nearest = std::min(nearest, (x - corner).norm());
    EXPECT_LE(nearest, 1e-13 * t.size.norm());
  }
}

TEST(Domain, TessellationsFillItBeforeAndAfterRegularisation) {
  for (const int grains : {1, 2, 5, 100}) {
    const Domain domain = prism(12, 2, grains);
    Tessellation t = voronoi_tessellation(points_in(domain, grains), domain);
    expect_fills(t);
    const RegularisationReport report = regularise(t, {});
    expect_fills(t);
    if (grains == 100) {
      EXPECT_GT(report.deleted, 20);
      EXPECT_LT(report.short_after, report.short_before / 4);
    }
    const auto vertices = t.vertices;
    regularise(t, {});
    EXPECT_EQ(vertices, t.vertices);
  }
}

TEST(Domain, SeedsBeyondAnObliquePlaneAreRefused) {
  const Domain domain = prism(12, 2, 10);
  EXPECT_THROW(voronoi_tessellation({Vec3(0.01, 0.01, 0.5)}, domain), core::InputError);
}

}  // namespace
}  // namespace polyslip::mesh
