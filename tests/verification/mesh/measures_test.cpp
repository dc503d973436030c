// Sizes and shapes of grains against what is known of Poisson-Voronoi tessellations.

#include "mesh/measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace polyslip::mesh {
namespace {

/// Means over the inner grains of Poisson-Voronoi cubes.
struct Sums {
  double grains = 0, faces = 0, edges = 0;
  void add(const Measures& m) {
    for (const GrainMeasures& g : m.grains) {
      if (!g.inner) continue;
      ++grains;
      faces += g.faces;
      edges += g.edges;
    }
  }
};

// 15.05 faces and 39.1 edges: 1,000 grains (many cubes; the paper's 15.1 and 39.1 are those of
// about 1,000). Endless tessellations: 15.5355; the inner grains of a cube are the smaller ones.
TEST(MeasuresOfVoronoi, InnerGrainsOfCubesOfAThousand) {
  Sums sums;
  for (int seed = 1; seed <= 8; ++seed) {
    PolycrystalOptions options;
    options.grains = 1000;
    options.seed = 40 + seed;
    sums.add(measure(voronoi_tessellation(options)));
  }
  ASSERT_GT(sums.grains, 8 * 400);
  // Standard deviations of faces and edges of a cell are 3.3 and 10: three standard errors.
  EXPECT_NEAR(sums.faces / sums.grains, 15.05, 3 * 3.3 / std::sqrt(sums.grains));
  EXPECT_NEAR(sums.edges / sums.grains, 39.1, 3 * 10 / std::sqrt(sums.grains));
}

/// Per grain: area of the faces between grains, counted for both; length of all edges, counted for
/// the three grains of each; V^2.
core::Vec3 densities(int grains, int cubes) {
  core::Vec3 sum = core::Vec3::Zero();
  for (int seed = 1; seed <= cubes; ++seed) {
    PolycrystalOptions options;
    options.grains = grains;
    options.seed = 60 + seed;
    const Measures m = measure(voronoi_tessellation(options));
    for (const FaceMeasures& f : m.faces)
      if (f.domain_face < 0) sum[0] += 2 * f.area;
    for (const EdgeMeasures& e : m.edges) sum[1] += 3 * e.length;
    for (const GrainMeasures& g : m.grains) sum[2] += g.volume * g.volume;
  }
  return sum / (grains * cubes);
}

// Endless Poisson-Voronoi tessellation of unit density: mean area of a cell (256 pi/3)^(1/3)
// Gamma(5/3) = 5.8209 and length of its edges 17.4955 (J. L. Meijering, 1953), second moment of its
// volume 1.179 (E. N. Gilbert, 1962). A cube's surface changes these by a share of n^(-1/3), which
// two sizes cancel.
TEST(MeasuresOfVoronoi, AreasLengthsAndVolumes) {
  const core::Vec3 endless = 2 * densities(8000, 2) - densities(1000, 16);
  EXPECT_NEAR(endless[0], 5.8209, 0.03);
  EXPECT_NEAR(endless[1], 17.4955, 0.1);
  EXPECT_NEAR(endless[2], 1.179, 0.06);  // standard error 0.02
}

}  // namespace
}  // namespace polyslip::mesh
