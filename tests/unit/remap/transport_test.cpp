#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "mesh/quadrature.hpp"
#include "remap/audit.hpp"
#include "remap/donor_average.hpp"
#include "remap/remesh.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::remap {
namespace {

using core::Transport;
using core::Vec3;
using mesh::Field;

Vec3 curl(const Vec3& x) { return {0.03 * x[1] * x[1], 0.02 * x[0] * x[2], 0.01 * x[0] * x[1]}; }

/// Two grains, coarse; state constant in each element, orientation constant in each grain.
mesh::Snapshot old_snapshot(int points = 4) {
  mesh::Snapshot s;
  s.quadrature_points = points;
  s.mesh = tests::box_mesh({4, 2, 2}, Vec3(2, 1, 1), 2);
  s.strain = 0.3;
  s.time = 0.31;
  Field displacement{
      "displacement", mesh::Location::node, 3, "1", Transport::shape_functions, "", {}};
  for (const Vec3& x : s.mesh.nodes)
    for (int c = 0; c < 3; ++c) displacement.values.push_back(curl(x)[c]);
  Field g{"g", mesh::Location::quadrature_point, 1, "MPa", Transport::element_average, "", {}};
  Field orientation{"orientation",
                    mesh::Location::quadrature_point,
                    4,
                    "1",
                    Transport::orientation_average,
                    "",
                    {}};
  Field elastic{
      "elastic_strain", mesh::Location::quadrature_point, 5, "1", Transport::reset_to_zero, "", {}};
  Field history{"velocity", mesh::Location::node, 3, "1/s", Transport::not_carried, "", {}};
  for (int e = 0; e < s.mesh.element_count(); ++e)
    for (int q = 0; q < points; ++q) {
      const int grain = s.mesh.tetrahedron_cell[e];
      g.values.push_back(10 + grain + 0.1 * (q - 1.5));
      // The same rotation with changing sign: a mean that adds components would be zero.
      const core::Quaternion turn = core::exp_axial(Vec3(0.2 + grain, 0.1, 0.01 * (q - 1.5)));
      const double sign = q % 2 == 0 ? 1 : -1;
      for (double c : {turn.w(), turn.x(), turn.y(), turn.z()})
        orientation.values.push_back(sign * c);
      for (int c = 0; c < 5; ++c) elastic.values.push_back(1e-4);
    }
  history.values.assign(s.mesh.nodes.size() * 3, 1.0);
  s.fields = {displacement, g, orientation, elastic, history};
  s.history["step"] = {0.02};
  return s;
}

TEST(Transport, CarriesElementMeansWithinTheGrain) {
  const mesh::Snapshot old = old_snapshot();
  const mesh::Snapshot fresh = transport(old, tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  ASSERT_EQ(fresh.mesh.element_count(), 6 * 3 * 3 * 6);
  EXPECT_EQ(fresh.mesh_number, 1);
  EXPECT_EQ(fresh.strain, 0.3);
  EXPECT_EQ(fresh.time, 0.31);
  const Field* g = fresh.find("g");
  ASSERT_TRUE(g);
  ASSERT_EQ(g->values.size(), 4u * fresh.mesh.tetrahedra.size());
  for (std::size_t i = 0; i < g->values.size(); ++i)
    EXPECT_NEAR(g->values[i], 10 + fresh.mesh.tetrahedron_cell[i / 4], 1e-12);
}

/// The weights differ, so that a plain mean would be another number.
TEST(Transport, WeighsOtherNumbersOfPointsByTheirRule) {
  for (const int points : {8, 14, 15}) {
    SCOPED_TRACE(points);
    const mesh::Snapshot fresh =
        transport(old_snapshot(points), tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
    double mean = 0, plain = 0;
    for (int q = 0; q < points; ++q) {
      mean += 6 * mesh::tet_quadrature(points)[q].weight * 0.1 * (q - 1.5);
      plain += 0.1 * (q - 1.5) / points;
    }
    EXPECT_GT(std::abs(mean - plain), 1e-3);
    EXPECT_EQ(fresh.quadrature_points, points);
    const Field* g = fresh.find("g");
    ASSERT_TRUE(g);
    ASSERT_EQ(g->values.size(), static_cast<std::size_t>(points) * fresh.mesh.tetrahedra.size());
    for (std::size_t i = 0; i < g->values.size(); ++i) {
      const int grain = fresh.mesh.tetrahedron_cell[i / static_cast<std::size_t>(points)];
      EXPECT_NEAR(g->values[i], 10 + grain + mean, 1e-12);
    }
  }
}

TEST(Transport, ResetsStressesAndDropsHistory) {
  const mesh::Snapshot fresh =
      transport(old_snapshot(), tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  const Field* elastic = fresh.find("elastic_strain");
  ASSERT_TRUE(elastic);
  ASSERT_EQ(elastic->values.size(), 20u * fresh.mesh.tetrahedra.size());
  for (double v : elastic->values) EXPECT_EQ(v, 0);
  EXPECT_FALSE(fresh.find("velocity"));
  EXPECT_TRUE(fresh.history.empty());
}

TEST(Transport, AveragesOrientationsAsRotations) {
  const mesh::Snapshot fresh =
      transport(old_snapshot(), tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  const auto means = grain_orientations(fresh);
  ASSERT_EQ(means.size(), 2u);
  for (int grain = 0; grain < 2; ++grain)
    EXPECT_LT(means[grain].angularDistance(core::exp_axial(Vec3(0.2 + grain, 0.1, 0))), 1e-4);
  const Field* orientation = fresh.find("orientation");
  ASSERT_TRUE(orientation);
  for (std::size_t i = 0; i < orientation->values.size(); i += 4)
    EXPECT_NEAR(Eigen::Map<const Eigen::Vector4d>(&orientation->values[i]).norm(), 1, 1e-12);
}

TEST(Transport, InterpolatesNodalFieldsByTheShapeFunctions) {
  // A quadratic field is in the space of the shape functions of straight elements.
  const mesh::Snapshot fresh =
      transport(old_snapshot(), tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  const Field* displacement = fresh.find("displacement");
  ASSERT_TRUE(displacement);
  ASSERT_EQ(displacement->values.size(), 3 * fresh.mesh.nodes.size());
  for (std::size_t n = 0; n < fresh.mesh.nodes.size(); ++n)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(displacement->values[3 * n + c], curl(fresh.mesh.nodes[n])[c], 1e-12);
}

TEST(PointVolumes, AddUpToTheBox) {
  double sum = 0;
  for (double v : point_volumes(old_snapshot())) sum += v;
  EXPECT_NEAR(sum, 2, 1e-12);
}

TEST(MeshingScale, UndoesShorteningAndLengtheningByTheirShares) {
  mesh::Mesh mesh = tests::box_mesh({2, 1, 1}, Vec3(2, 1, 1));
  for (Vec3& x : mesh.nodes) x = x.cwiseProduct(Vec3(1.25, 1, 0.8));
  const auto scale = [&](double shortening, double lengthening) {
    RemeshingOptions options;
    options.orthotropic_share = shortening;
    options.lengthening_share = lengthening;
    return meshing_scale(mesh, options);
  };
  EXPECT_LT((scale(1, 0) - Vec3(1, 1, 1.25)).norm(), 1e-14);
  EXPECT_LT((scale(0.5, 0) - Vec3(1, 1, std::sqrt(1.25))).norm(), 1e-14);
  EXPECT_LT((scale(0, 1) - Vec3(0.8, 1, 1)).norm(), 1e-14);
  EXPECT_LT((scale(1, 0.5) - Vec3(std::sqrt(0.8), 1, 1.25)).norm(), 1e-14);
  EXPECT_EQ(scale(0, 0), Vec3(1, 1, 1));
}

TEST(Audit, NamesTheGrainWhoseVolumeChanged) {
  const mesh::Snapshot old = old_snapshot();
  mesh::Snapshot fresh = transport(old, tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  RemeshReport report;
  report.strain = 0.3;
  EXPECT_EQ(audit(old, fresh, {}, report), "");
  EXPECT_LT(report.max_grain_volume_change, 1e-12);
  EXPECT_LT(report.max_mean_rotation, 1e-5);
  EXPECT_EQ(report.elements_before, 96);
  EXPECT_EQ(report.elements_after, 324);
  EXPECT_GT(report.min_radius_ratio_after, 0.3);

  for (Vec3& x : fresh.mesh.nodes)
    if (x[0] > 1) x[0] = 1 + 1.01 * (x[0] - 1);
  EXPECT_NE(audit(old, fresh, {}, report).find("the volume of grain 2 changed by 1 %"),
            std::string::npos)
      << report.max_grain_volume_change;
}

TEST(Audit, NamesTheGrainThatTurned) {
  const mesh::Snapshot old = old_snapshot();
  mesh::Snapshot fresh = transport(old, tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  const core::Quaternion turn = core::exp_axial(Vec3(0, 0, 6 / core::degrees_per_radian));
  Field& orientation = *fresh.find("orientation");
  for (std::size_t i = orientation.values.size() / 2; i < orientation.values.size(); i += 4) {
    double* q = &orientation.values[i];
    const core::Quaternion turned = turn * core::Quaternion(q[0], q[1], q[2], q[3]);
    q[0] = turned.w(), q[1] = turned.x(), q[2] = turned.y(), q[3] = turned.z();
  }
  RemeshReport report;
  const std::string beyond = audit(old, fresh, {}, report);
  EXPECT_NE(beyond.find("the mean orientation of grain 2 changed by 6 degrees"), std::string::npos)
      << beyond;
  EXPECT_NEAR(report.max_mean_rotation, 6, 1e-3);
  RemeshingOptions loose;
  loose.max_grain_rotation = 7;
  EXPECT_EQ(audit(old, fresh, loose, report), "");
}

TEST(Audit, NamesTheGrainWhoseResistanceChanged) {
  const mesh::Snapshot old = old_snapshot();
  mesh::Snapshot fresh = transport(old, tests::box_mesh({6, 3, 3}, Vec3(2, 1, 1), 2));
  Field& g = *fresh.find("g");
  for (std::size_t i = 0; i < g.values.size() / 2; ++i) g.values[i] *= 1.08;
  RemeshReport report;
  EXPECT_NE(audit(old, fresh, {}, report).find("the mean g of grain 1 changed by 8 %"),
            std::string::npos);
}

}  // namespace
}  // namespace polyslip::remap
