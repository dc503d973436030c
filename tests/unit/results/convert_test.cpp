#include "results/convert.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"
#include "results/state_series.hpp"

namespace polyslip {
namespace {

using mesh::Location;
using results::ElementValue;
using tests::fabricated_snapshot;

/// Positions of all quadrature points, so many an element.
std::vector<core::Vec3> point_positions(const mesh::Mesh& mesh, int points) {
  std::vector<core::Vec3> all;
  for (const auto& nodes : mesh.tetrahedra)
    for (const auto& point : mesh::tet_quadrature(points)) {
      const auto n = mesh::tet10_shape(point.xi);
      core::Vec3 x = core::Vec3::Zero();
      for (int i = 0; i < 10; ++i) x += n[i] * mesh.nodes[nodes[i]];
      all.push_back(x);
    }
  return all;
}

TEST(ElementValues, VolumesAndCentroidsOfCurvedElementsAddUp) {
  auto s = fabricated_snapshot(2, 0.4);
  const auto t = results::element_values(s, ElementValue::average);
  double volume = 0;
  for (int e = 0; e < s.mesh.element_count(); ++e) {
    EXPECT_GT(t.volume[e], 0);
    EXPECT_NEAR(t.volume[e], mesh::element_volume(s.mesh, e), 1e-15);
    volume += t.volume[e];
  }
  const auto grains = mesh::grain_volumes(s.mesh);
  EXPECT_NEAR(volume, std::accumulate(grains.begin(), grains.end(), 0.0), 1e-12);
  EXPECT_GT(volume, 1);
}

TEST(ElementValues, CentroidOfALinearFieldIsExactOnStraightElements) {
  for (const int points : mesh::tet_quadrature_sizes) {
    SCOPED_TRACE(points);
    mesh::Snapshot s;
    s.mesh = tests::two_grains(2);
    s.quadrature_points = points;
    tests::distort(s.mesh, 0.1);
    mesh::Field strain{"equivalent_strain",
                       Location::quadrature_point,
                       1,
                       "1",
                       core::Transport::element_average,
                       "made up",
                       {}};
    for (const core::Vec3& x : point_positions(s.mesh, points))
      strain.values.push_back(1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2]);
    s.fields.push_back(strain);
    for (const auto value : {ElementValue::centroid, ElementValue::average}) {
      const auto t = results::element_values(s, value);
      for (int e = 0; e < s.mesh.element_count(); ++e) {
        const auto& x = t.centroid[e];
        EXPECT_NEAR(t.equivalent_strain[e], 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2], 1e-13);
      }
    }
  }
}

TEST(ElementValues, OfFifteenPointsTheOneAtTheCentroidIsItsValue) {
  mesh::Snapshot s;
  s.mesh = tests::two_grains(1);
  s.quadrature_points = 15;
  tests::Numbers numbers;
  const std::size_t rows = 15 * s.mesh.tetrahedra.size();
  s.fields.push_back(
      tests::field("equivalent_strain", Location::quadrature_point, 1, "1", rows, numbers));
  const auto t = results::element_values(s, ElementValue::centroid);
  for (std::size_t e = 0; e < s.mesh.tetrahedra.size(); ++e)
    EXPECT_EQ(t.equivalent_strain[e], s.fields[0].values[15 * e]);
}

TEST(ElementValues, AverageWeighsPointsByTheirVolume) {
  auto s = fabricated_snapshot(1, 0.5);
  const auto& slip = s.find("slip", Location::quadrature_point)->values;
  const auto average = results::element_values(s, ElementValue::average);
  const auto centroid = results::element_values(s, ElementValue::centroid);
  double largest = 0;
  for (int e = 0; e < s.mesh.element_count(); ++e) {
    std::array<core::Vec3, 10> x;
    for (int i = 0; i < 10; ++i) x[i] = s.mesh.nodes[s.mesh.tetrahedra[e][i]];
    double sum = 0, volume = 0, plain = 0;
    const auto rule = mesh::tet_quadrature_4();
    for (int p = 0; p < 4; ++p) {
      const double w =
          mesh::tet10_jacobian(x, mesh::tet10_gradients(rule[p].xi)).determinant() / 24;
      sum += w * slip[4 * e + p];
      volume += w;
      plain += slip[4 * e + p] / 4;
    }
    EXPECT_NEAR(average.slip[e], sum / volume, 1e-14);
    EXPECT_NEAR(centroid.slip[e], plain, 1e-14);
    largest = std::max(largest, std::abs(average.slip[e] - centroid.slip[e]));
  }
  EXPECT_GT(largest, 1e-3);
}

TEST(ElementValues, OrientationKeepsTheSignOfItsFirstPoint) {
  auto s = fabricated_snapshot(1, 0.2);
  const auto before = results::element_values(s, ElementValue::average).orientation;
  auto& q = s.find("orientation", Location::quadrature_point)->values;
  for (int c = 0; c < 4; ++c) q[4 + c] *= -1;    // second point of the first element
  for (int c = 0; c < 16; ++c) q[16 + c] *= -1;  // all of the second element
  for (const auto value : {ElementValue::average, ElementValue::centroid}) {
    const auto after = results::element_values(s, value).orientation;
    EXPECT_NEAR(after[0].norm(), 1, 1e-14);
    EXPECT_LT((after[0].coeffs() - before[0].coeffs()).norm(), 1e-2);
    EXPECT_LT((after[1].coeffs() + before[1].coeffs()).norm(), 1e-2);
  }
}

TEST(ElementValues, PointStressComesBeforeElementStress) {
  auto s = fabricated_snapshot(1, 0.2);
  for (auto& v : s.find("cauchy_stress", Location::quadrature_point)->values) v = 3;
  auto t = results::element_values(s, ElementValue::average);
  EXPECT_NEAR((t.cauchy_stress[5] - core::Vec6::Constant(3)).norm(), 0, 1e-14);
  EXPECT_NEAR(t.pressure[5], -3, 1e-14);  // of the stress beside it in the table
  std::erase_if(s.fields, [](const auto& f) { return f.location == Location::element; });
  EXPECT_NEAR(results::element_values(s, ElementValue::average).pressure[5], -3, 1e-14);
  std::erase_if(s.fields, [](const auto& f) { return f.name != "displacement"; });
  t = results::element_values(s, ElementValue::average);
  EXPECT_EQ(t.cauchy_stress[5], core::Vec6::Zero());
  EXPECT_TRUE(std::isnan(t.g[5]));
}

struct StoredRun : tests::TemporaryFolder {
  StoredRun() {
    std::filesystem::create_directory(*this / "results");
    results::StateSeries series(path());
    series.store(fabricated_snapshot(1, 0.1));
    series.store(fabricated_snapshot(1, 0.5));
  }
};

TEST(Convert, WritesARowAnElementOfTheNearestState) {
  const StoredRun run;
  const auto state = results::convert(run.path(), 0.42, run / "e.csv", ElementValue::average);
  EXPECT_EQ(state.strain, 0.5);
  std::istringstream lines(tests::slurp(run / "e.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "element,grain,x,y,z,volume,q0,q1,q2,q3,g,slip,equivalent_strain,sxx,syy,szz,syz,szx,"
            "sxy,pressure");
  const auto s = fabricated_snapshot(1, 0.5);
  const auto t = results::element_values(s, ElementValue::average);
  int rows = 0;
  for (; std::getline(lines, line); ++rows) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> v;
    for (std::string word; words >> word;) v.push_back(std::stod(word));
    ASSERT_EQ(v.size(), 20u);
    EXPECT_EQ(v[0], rows + 1);
    EXPECT_EQ(v[1], s.mesh.tetrahedron_cell[rows] + 1);
    EXPECT_EQ(v[2], t.centroid[rows][0]);
    EXPECT_EQ(v[5], t.volume[rows]);
    EXPECT_EQ(v[6], t.orientation[rows].w());
    EXPECT_EQ(v[9], t.orientation[rows].z());
    EXPECT_EQ(v[11], t.slip[rows]);
    EXPECT_EQ(v[18], t.cauchy_stress[rows][5]);
    EXPECT_EQ(v[19], t.pressure[rows]);
  }
  EXPECT_EQ(rows, 12);
}

TEST(Convert, RefusesWhatItCannotDo) {
  const StoredRun run;
  const tests::TemporaryFolder empty;
  const auto average = ElementValue::average;
  EXPECT_THROW(results::convert(empty.path(), 0.1, run / "e.csv", average), core::InputError);
  EXPECT_THROW(results::convert(run.path(), NAN, run / "e.csv", average), core::InputError);
  EXPECT_THROW(results::convert(run.path(), 0.1, run / "none/e.csv", average), core::InputError);
  std::filesystem::resize_file(run / "results/state-0000.h5", 3000);
  EXPECT_THROW(results::convert(run.path(), 0.1, run / "e.csv", average), core::InputError);
  EXPECT_FALSE(std::filesystem::exists(run / "e.csv"));
}

}  // namespace
}  // namespace polyslip
