#include "mesh/curved_elements.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "mesh/curvature_bound.hpp"
#include "star_meshes.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;
using namespace test;

TEST(CurvedElements, AreMendedInsideFirstAndThenAtTheSurface) {
  MeshingReport report;
  auto options = options_of(0.5);
  options.slide_boundary = false;
  const Mesh flat = star_mesh(cubes(1), options, report);
  for (double bulge : {0.08, 0.25}) {
    Mesh mesh = flat;
    std::vector<char> corner(mesh.nodes.size(), false);
    for (const auto& t : mesh.tetrahedra)
      for (int i = 0; i < 4; ++i) corner[t[i]] = true;
    for (const auto& t : mesh.triangles)
      for (int i = 3; i < 6; ++i)
        if (std::abs(mesh.nodes[t[i]][0] - 1) < 1e-12) mesh.nodes[t[i]][0] = 1 - bulge;
    const Mesh bent = mesh;
    double worst = 1;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const double least = least_jacobian_ratio(mesh, e), bound = curvature_bound(mesh, e);
      worst = std::min(worst, least);
      if (bound < 1) {
        EXPECT_GE(least, std::pow(1 - bound, 3) * (1 - 1e-12));
      }
    }
    Mesh other = mesh;
    const int moved = mend_curved_elements(mesh);
    EXPECT_EQ(mend_curved_elements(other, 3), moved);
    EXPECT_EQ(other.nodes, mesh.nodes);
    EXPECT_NO_THROW(check(mesh, 3));
    for (int e = 0; e < mesh.element_count(); ++e) EXPECT_GE(least_jacobian_ratio(mesh, e), 0.1);
    ASSERT_NO_THROW(check(mesh));
    int differ = 0, surface = 0;
    std::vector<char> on_surface(mesh.nodes.size(), false);
    for (const auto& t : mesh.triangles)
      for (int n : t) on_surface[n] = true;
    for (int n = 0; n < mesh.node_count(); ++n)
      if (mesh.nodes[n] != bent.nodes[n]) {
        EXPECT_FALSE(corner[n]);
        ++differ;
        surface += on_surface[n];
      }
    EXPECT_EQ(surface, moved);
    EXPECT_LT(worst, 0.1);
    EXPECT_GT(differ, 0);
    if (bulge > 0.2) {
      EXPECT_LT(worst, 0);
      EXPECT_GT(moved, 0);
    } else {
      EXPECT_EQ(moved, 0) << "inner mid nodes are enough";
    }
  }
  Mesh broken = flat;  // an element without volume whose curved edges do not help it
  const auto& t = broken.tetrahedra[3];
  broken.nodes[t[3]] = broken.nodes[t[0]];
  broken.nodes[t[4]] += Vec3(0.01, 0, 0);
  try {
    mend_curved_elements(broken);
    FAIL() << "nothing was thrown";
  } catch (const core::RecoverableError& error) {
    EXPECT_NE(std::string(error.what()).find("of grain 1 has no positive volume"),
              std::string::npos)
        << error.what();
  }
  broken = flat;
  broken.nodes[broken.tetrahedra[3][4]][1] = std::nan("");
  EXPECT_TRUE(std::isnan(least_jacobian_ratio(broken, 3)));
  Mesh linear = flat;
  linear.order = 1;
  EXPECT_EQ(mend_curved_elements(linear), 0);
}

}  // namespace
}  // namespace polyslip::mesh
