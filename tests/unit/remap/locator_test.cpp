#include "remap/locator.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "mesh/shape_functions.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::remap {
namespace {

using core::Vec3;

Vec3 place(const mesh::Mesh& mesh, int element, const Vec3& xi) {
  const auto shape = mesh::tet10_shape(xi);
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 10; ++i) x += shape[i] * mesh.nodes[mesh.tetrahedra[element][i]];
  return x;
}

/// Curved elements: every node moved by a smooth quadratic field.
mesh::Mesh curved_mesh() {
  mesh::Mesh mesh = tests::box_mesh({4, 3, 3}, Vec3(2, 1.5, 1.5), 2);
  for (Vec3& x : mesh.nodes) x += Vec3(0.06 * x[1] * x[1], 0.05 * x[0] * x[2], 0.04 * x[0] * x[1]);
  return mesh;
}

TEST(LocateInElement, InvertsTheQuadraticMap) {
  const mesh::Mesh mesh = curved_mesh();
  core::Random random(1, core::Stream::tests);
  for (int e = 0; e < mesh.element_count(); e += 7) {
    const Vec3 xi(0.3 * random.uniform(), 0.3 * random.uniform(), 0.3 * random.uniform());
    const Location found = locate_in_element(mesh, e, place(mesh, e, xi));
    EXPECT_LT((found.xi - xi).norm(), 1e-11);
    EXPECT_EQ(found.excess, 0);
  }
}

TEST(LocateInElement, TellsHowFarOutsideAPointLies) {
  const mesh::Mesh mesh = tests::box_mesh({1, 1, 1}, Vec3::Ones());
  const Vec3 xi(-0.2, 0.5, 0.5);
  EXPECT_NEAR(locate_in_element(mesh, 0, place(mesh, 0, xi)).excess, 0.2, 1e-12);
}

TEST(ElementLocator, FindsTheElementThatHoldsAPoint) {
  const mesh::Mesh mesh = curved_mesh();
  const ElementLocator locator(mesh);
  core::Random random(2, core::Stream::tests);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Vec3 xi(0.05 + 0.25 * random.uniform(), 0.05 + 0.25 * random.uniform(),
                  0.05 + 0.25 * random.uniform());
    const Location found = locator.find(place(mesh, e, xi), mesh.tetrahedron_cell[e]);
    EXPECT_EQ(found.element, e);
    EXPECT_LT((found.xi - xi).norm(), 1e-10);
  }
}

TEST(ElementLocator, StaysInTheGrainThatIsAsked) {
  const mesh::Mesh mesh = tests::box_mesh({4, 2, 2}, Vec3(2, 1, 1), 2);
  const ElementLocator locator(mesh);
  const Location found = locator.find(Vec3(0.99, 0.4, 0.4), 1);  // just inside grain 0
  EXPECT_EQ(mesh.tetrahedron_cell[found.element], 1);
  EXPECT_GT(found.excess, 0);
  EXPECT_LT(found.excess, 0.1);
}

}  // namespace
}  // namespace polyslip::remap
