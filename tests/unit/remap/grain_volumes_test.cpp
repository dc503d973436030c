// Elastic compression through a remeshing with stresses zero: it stays, so that no volume is lost.

#include "remap/grain_volumes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "remap/donor_average.hpp"
#include "remap/grain_statistics.hpp"
#include "remap/transport.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::remap {
namespace {

using core::Transport;
using mesh::Field;
using mesh::Location;

constexpr double bulk = 76e3;  // MPa
const core::Vec3 size(2, 1, 1);

double pressure_of(int element) { return 15 + 5 * std::sin(element); }

/// Two grains, elements under other pressures.
mesh::Snapshot compressed() {
  mesh::Snapshot s;
  s.mesh = tests::box_mesh({6, 3, 3}, size, 2);
  tests::distort(s.mesh, 0.2);
  const auto at_points = point_volumes(s);
  Field volume{"volume", Location::element, 1, "L^3", Transport::not_carried, "", {}};
  Field reference{"reference_volume", Location::element, 1, "L^3", Transport::not_carried, "", {}};
  Field pressure{"pressure", Location::element, 1, "MPa", Transport::reset_to_zero, "", {}};
  Field mean{"cauchy_stress", Location::element, 6, "MPa", Transport::reset_to_zero, "", {}};
  Field stress{
      "cauchy_stress", Location::quadrature_point, 6, "MPa", Transport::reset_to_zero, "", {}};
  for (int e = 0; e < s.mesh.element_count(); ++e) {
    double v = 0;
    for (std::size_t q = 0; q < 4; ++q) v += at_points[4 * static_cast<std::size_t>(e) + q];
    volume.values.push_back(v);
    pressure.values.push_back(pressure_of(e));
    reference.values.push_back(v * std::exp(pressure_of(e) / bulk));
  }
  mean.values.assign(volume.values.size() * 6, 20);
  stress.values.assign(volume.values.size() * 24, 20);
  s.fields = {volume, reference, pressure, mean, stress};
  return s;
}

mesh::Mesh other_mesh() {
  mesh::Mesh mesh = tests::box_mesh({4, 2, 2}, size, 2);
  tests::distort(mesh, 0.2);
  return mesh;
}

std::array<double, 2> sums(const mesh::Snapshot& s, const char* name) {
  std::array<double, 2> sum{};
  const Field* field = s.find(name, Location::element);
  for (std::size_t e = 0; field && e < field->values.size(); ++e)
    sum[s.mesh.tetrahedron_cell[e]] += field->values[e];
  return sum;
}

TEST(GrainCompression, EveryGrainKeepsItsVolumeAtZeroPressure) {
  const mesh::Snapshot old = compressed(), fresh = transport(old, other_mesh());
  const auto reference = sums(old, "reference_volume"), volume = sums(old, "volume");
  const auto kept = sums(fresh, "reference_volume"), now = sums(fresh, "volume");
  const auto statistics = grain_statistics(fresh);
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_GT(reference[g] / volume[g], 1 + 15e-5);
    EXPECT_NEAR(kept[g] / now[g], reference[g] / volume[g], 1e-12);
    EXPECT_NEAR(statistics[g].volume_at_zero_pressure, kept[g], 1e-12);
  }
  EXPECT_NEAR(now[0] + now[1], size.prod(), 1e-12);
}

TEST(GrainCompression, StressesAreAllPressureAndBelongToTheVolumes) {
  const mesh::Snapshot fresh = transport(compressed(), other_mesh());
  const auto& pressure = fresh.find("pressure", Location::element)->values;
  const auto& volume = fresh.find("volume", Location::element)->values;
  const auto& reference = fresh.find("reference_volume", Location::element)->values;
  const auto& mean = fresh.find("cauchy_stress", Location::element)->values;
  const auto& stress = fresh.find("cauchy_stress", Location::quadrature_point)->values;
  ASSERT_EQ(stress.size(), 24 * pressure.size());
  for (std::size_t e = 0; e < pressure.size(); ++e) {
    EXPECT_GT(pressure[e], 10);
    // Means of ln(V/V0) and of V/V0 over elements at 10 to 20 MPa differ by less than 1e-3 MPa.
    EXPECT_NEAR(pressure[e], -bulk * std::log(volume[e] / reference[e]), 1e-3);
    for (std::size_t c = 0; c < 6; ++c) {
      EXPECT_EQ(mean[6 * e + c], c < 3 ? -pressure[e] : 0);
      for (std::size_t q = 0; q < 4; ++q)
        EXPECT_EQ(stress[24 * e + 6 * q + c], c < 3 ? -pressure[e] : 0);
    }
  }
}

/// The displacement element has its volume ratio at the points.
TEST(GrainCompression, GoesToThePointsOfElementsThatHaveItThere) {
  mesh::Snapshot old = compressed();
  Field ratio{"volume_ratio", Location::quadrature_point, 1, "1", Transport::not_carried, "", {}};
  ratio.values.assign(4 * old.mesh.tetrahedra.size(), 0.5);
  old.fields.push_back(ratio);
  const mesh::Snapshot fresh = transport(old, other_mesh());
  const auto& volume = fresh.find("volume", Location::element)->values;
  const auto& reference = fresh.find("reference_volume", Location::element)->values;
  const Field* kept = fresh.find("volume_ratio", Location::quadrature_point);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->values.size(), 4 * volume.size());
  for (std::size_t i = 0; i < kept->values.size(); ++i)
    EXPECT_NEAR(kept->values[i], volume[i / 4] / reference[i / 4], 1e-14);
}

TEST(GrainCompression, IsNoneWhereNoVolumeAtZeroPressureIsKnown) {
  mesh::Snapshot old = compressed();
  std::erase_if(old.fields, [](const Field& f) { return f.name == "reference_volume"; });
  const mesh::Snapshot fresh = transport(old, other_mesh());
  EXPECT_FALSE(fresh.find("reference_volume"));
  for (const double p : fresh.find("pressure")->values) EXPECT_EQ(p, 0);
}

}  // namespace
}  // namespace polyslip::remap
