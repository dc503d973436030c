// Transport by points, with grains corrected, and with stresses.

#include <gtest/gtest.h>

#include <cmath>

#include "core/rotation.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"
#include "remap/donor_average.hpp"
#include "remap/grain_statistics.hpp"
#include "remap/transport.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::remap {
namespace {

using core::Transport;
using core::Vec3;
using mesh::Field;

Vec3 size() { return {2, 1, 1}; }

Field field(const std::string& name, mesh::Location location, int components, Transport transport) {
  return {name, location, components, "1", transport, "", {}};
}

/// Two grains whose orientation and g vary smoothly.
mesh::Snapshot old_snapshot() {
  mesh::Snapshot s;
  s.mesh = tests::box_mesh({8, 4, 4}, size(), 2);
  tests::distort(s.mesh, 0.2);
  const auto point = mesh::Location::quadrature_point;
  Field orientation = field("orientation", point, 4, Transport::orientation_average);
  Field g = field("g", point, 1, Transport::element_average);
  Field elastic = field("elastic_strain", point, 5, Transport::reset_to_zero);
  Field stress = field("cauchy_stress", point, 6, Transport::reset_to_zero);
  Field pressure = field("pressure", mesh::Location::element, 1, Transport::reset_to_zero);
  Field volume = field("volume", mesh::Location::element, 1, Transport::not_carried);
  Field reference = field("reference_volume", mesh::Location::element, 1, Transport::not_carried);
  const auto volumes = point_volumes(s);
  for (int e = 0; e < s.mesh.element_count(); ++e) {
    double v = 0;
    for (int q = 0; q < 4; ++q) {
      const auto shape = mesh::tet10_shape(mesh::tet_quadrature_4()[q].xi);
      Vec3 x = Vec3::Zero();
      for (int i = 0; i < 10; ++i) x += shape[i] * s.mesh.nodes[s.mesh.tetrahedra[e][i]];
      const core::Quaternion turn = core::exp_axial(
          Vec3(0.1 * std::sin(3 * x[0] + x[1]), 0.08 * x[1] * x[2], 0.1 * std::cos(2 * x[2])));
      for (double c : {turn.w(), turn.x(), turn.y(), turn.z()}) orientation.values.push_back(c);
      g.values.push_back(10 + std::sin(2 * x[0]) * x[1]);
      for (int c = 0; c < 5; ++c) elastic.values.push_back(1e-4 * (c + 1) * x[0]);
      for (int c = 0; c < 6; ++c) stress.values.push_back(c < 3 ? -30.0 : 1.0);
      v += volumes[4 * static_cast<std::size_t>(e) + static_cast<std::size_t>(q)];
    }
    pressure.values.push_back(30);
    volume.values.push_back(v);
    reference.values.push_back(v * (1 + 1e-3 * (e % 7)));
  }
  s.fields = {orientation, g, elastic, stress, pressure, volume, reference};
  return s;
}

mesh::Mesh new_mesh() {
  mesh::Mesh mesh = tests::box_mesh({6, 3, 3}, size(), 2);
  tests::distort(mesh, 0.25);
  return mesh;
}

TransportOptions by(const std::string& state, const std::string& stress = "zero") {
  return {state, stress};
}

/// Onto the same mesh it is the identity, bit for bit; by elements it is not.
TEST(PointTransport, OntoTheSameMeshChangesNothing) {
  const mesh::Snapshot old = old_snapshot();
  const mesh::Snapshot same = transport(old, old.mesh, by("point", "carried"));
  for (const char* name : {"orientation", "g", "elastic_strain", "cauchy_stress"}) {
    const auto point = mesh::Location::quadrature_point;
    EXPECT_EQ(same.find(name, point)->values, old.find(name, point)->values) << name;
  }
  EXPECT_NE(transport(old, old.mesh).find("g")->values, old.find("g")->values);
}

TEST(PointTransport, DoesNotDependOnThreads) {
  const mesh::Snapshot old = old_snapshot();
  for (const char* state : {"element", "point", "corrected"}) {
    const auto one = transport(old, new_mesh(), by(state), 1);
    const auto three = transport(old, new_mesh(), by(state), 3);
    ASSERT_EQ(one.fields.size(), three.fields.size());
    for (std::size_t f = 0; f < one.fields.size(); ++f)
      EXPECT_EQ(one.fields[f].values, three.fields[f].values) << state;
  }
}

/// Mean orientation, spread and mean g of each grain come back; without the correction they do not.
TEST(CorrectedTransport, KeepsWhatTheAuditLooksAt) {
  const mesh::Snapshot old = old_snapshot();
  const auto before = grain_statistics(old);
  const auto after = grain_statistics(transport(old, new_mesh(), by("corrected")));
  const auto plain = grain_statistics(transport(old, new_mesh(), by("point")));
  ASSERT_EQ(after.size(), 2u);
  for (std::size_t g = 0; g < 2; ++g) {
    const auto angle = [&](const GrainStatistics& s) {
      return before[g].orientation.angularDistance(s.orientation) * core::degrees_per_radian;
    };
    EXPECT_LT(angle(after[g]), 1e-4);
    EXPECT_GT(angle(plain[g]), 1e-3);
    EXPECT_NEAR(after[g].spread / before[g].spread, 1, 1e-6);
    EXPECT_GT(std::abs(plain[g].spread / before[g].spread - 1), 1e-5);
    EXPECT_NEAR(after[g].g.mean / before[g].g.mean, 1, 1e-3);
    EXPECT_GE(after[g].g.min, before[g].g.min);
    EXPECT_LE(after[g].g.max, before[g].g.max);
  }
}

TEST(CorrectedTransport, LeavesAUniformGrainAlone) {
  mesh::Snapshot old = old_snapshot();
  Field& orientation = *old.find("orientation");
  for (std::size_t i = 0; i < orientation.values.size(); i += 4) {
    orientation.values[i] = 0.8;
    orientation.values[i + 1] = 0.6;
    orientation.values[i + 2] = orientation.values[i + 3] = 0;
  }
  const mesh::Snapshot fresh = transport(old, new_mesh(), by("corrected"));
  const auto& values = fresh.find("orientation")->values;
  for (std::size_t i = 0; i < values.size(); i += 4) {
    EXPECT_NEAR(values[i], 0.8, 1e-12);
    EXPECT_NEAR(values[i + 1], 0.6, 1e-12);
  }
}

/// Pressure and V/V0 are the donor's, so that they still belong together.
TEST(CarriedStress, GoesWithItsVolumes) {
  const mesh::Snapshot old = old_snapshot();
  const mesh::Snapshot fresh = transport(old, new_mesh(), by("element", "carried"));
  const Field* volume = fresh.find("volume", mesh::Location::element);
  const Field* reference = fresh.find("reference_volume", mesh::Location::element);
  ASSERT_TRUE(volume && reference);
  double sum = 0;
  for (std::size_t e = 0; e < volume->values.size(); ++e) {
    const double part = (reference->values[e] / volume->values[e] - 1) / 1e-3;
    EXPECT_NEAR(part, std::round(part), 1e-9);
    sum += volume->values[e];
  }
  EXPECT_NEAR(sum, size().prod(), 1e-12);
  for (double p : fresh.find("pressure")->values) EXPECT_EQ(p, 30);
}

/// With s = diag(-30, -30, -30) + shears of 1 and e known: 1/2 s : e over the volume.
TEST(GrainStatistics, IntegratesElasticEnergy) {
  mesh::Snapshot s = old_snapshot();
  Field& orientation = *s.find("orientation");
  for (std::size_t i = 0; i < orientation.values.size(); ++i)
    orientation.values[i] = i % 4 == 0 ? 1 : 0;
  Field& elastic = *s.find("elastic_strain");
  for (std::size_t i = 0; i < elastic.values.size(); ++i)
    elastic.values[i] = i % 5 >= 2 ? 1e-3 : 0.5;  // shears; s has no deviatoric normal part
  Field& reference = *s.find("reference_volume", mesh::Location::element);
  reference.values = s.find("volume", mesh::Location::element)->values;
  for (double& v : reference.values) v *= std::exp(2e-3);  // pressure 30 compresses
  const auto grains = grain_statistics(s);
  ASSERT_EQ(grains.size(), 2u);
  EXPECT_NEAR(grains[0].volume + grains[1].volume, size().prod(), 1e-12);
  for (const auto& g : grains) {
    // shears of 1 MPa are sqrt 2 in the basis; pressure: 1/2 (-30) ln(exp(-2e-3))
    const double density = 0.5 * 3 * std::sqrt(2.0) * 1e-3 + 0.5 * 30 * 2e-3;
    EXPECT_NEAR(g.elastic_energy / g.volume, density, 1e-12);
    EXPECT_NEAR(g.spread, 0, 1e-6);
  }
}

/// Half the volume turned by +a about an axis, half by -a: spread a.
TEST(GrainStatistics, MeasuresTheSpread) {
  mesh::Snapshot s;
  s.mesh = tests::box_mesh({2, 1, 1}, size(), 1);
  Field orientation =
      field("orientation", mesh::Location::quadrature_point, 4, Transport::orientation_average);
  constexpr double a = 3 / core::degrees_per_radian;
  for (std::size_t i = 0; i < 4 * s.mesh.tetrahedra.size(); ++i) {
    const double angle = i % 2 == 0 ? a : -a;
    for (double c : {std::cos(angle / 2), 0.0, 0.0, std::sin(angle / 2)})
      orientation.values.push_back(c);
  }
  s.fields = {orientation};
  const auto grains = grain_statistics(s);
  ASSERT_EQ(grains.size(), 1u);
  EXPECT_NEAR(grains[0].spread, 3, 1e-9);
  EXPECT_LT(core::rotation_angle(grains[0].orientation), 1e-9);
}

}  // namespace
}  // namespace polyslip::remap
