// States without a mesh: what is written is read, and nothing else is taken for one.

#include "results/orientation_state.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.hpp"
#include "core/random.hpp"
#include "fabricated.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace polyslip {
namespace {

results::OrientationState some_state(int count) {
  core::Random random(1, core::Stream::tests);
  results::OrientationState s{0.25, 0.5, {}};
  for (int i = 0; i < count; ++i) {
    s.table.volume.push_back(1 + i);
    s.table.centroid.push_back(core::Vec3::Constant(NAN));
    s.table.orientation.push_back(random.rotation());
    s.table.g.push_back(8 + random.uniform());
    s.table.slip.push_back(random.uniform());
    s.table.equivalent_strain.push_back(random.uniform());
    core::Vec6 stress;
    for (int c = 0; c < 6; ++c) stress[c] = random.normal();
    s.table.cauchy_stress.push_back(stress);
    s.table.pressure.push_back(random.normal());
  }
  return s;
}

TEST(OrientationState, ReadsBackBitForBit) {
  const tests::TemporaryFolder folder;
  const auto s = some_state(7);
  results::write_orientation_state(folder / "a.h5", s);
  const auto r = results::read_orientation_state(folder / "a.h5");
  EXPECT_EQ(r.time, s.time);
  EXPECT_EQ(r.strain, s.strain);
  EXPECT_EQ(r.table.volume, s.table.volume);
  EXPECT_EQ(r.table.g, s.table.g);
  EXPECT_EQ(r.table.slip, s.table.slip);
  EXPECT_EQ(r.table.equivalent_strain, s.table.equivalent_strain);
  EXPECT_EQ(r.table.pressure, s.table.pressure);
  ASSERT_EQ(r.table.orientation.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(r.table.orientation[i].coeffs(), s.table.orientation[i].coeffs());
    EXPECT_EQ(r.table.cauchy_stress[i], s.table.cauchy_stress[i]);
  }
  EXPECT_TRUE(results::holds_orientations_only(folder / "a.h5"));
}

TEST(OrientationState, IsNoStateWithAMesh) {
  const tests::TemporaryFolder folder;
  results::write_orientation_state(folder / "a.h5", some_state(3));
  try {
    results::read_state(folder / "a.h5");
    FAIL() << "taken for a state with a mesh";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("holds orientations without a mesh"), std::string::npos);
  }
  results::write_state(folder / "b.h5", tests::fabricated_snapshot(2, 0.1));
  EXPECT_THROW(results::read_orientation_state(folder / "b.h5"), core::InputError);
}

TEST(OrientationState, DamageIsSeen) {
  const tests::TemporaryFolder folder;
  results::write_orientation_state(folder / "a.h5", some_state(3));
  {
    std::fstream file(folder / "a.h5", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(1500);
    file.put('x');
    file.put('y');
  }
  EXPECT_THROW(results::read_orientation_state(folder / "a.h5"), core::InputError);
  EXPECT_THROW(results::read_orientation_state(folder / "no.h5"), core::InputError);
}

TEST(OrientationState, SeriesHasNoXdmfFile) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "results");
  {
    results::StateSeries series(folder / "");
    EXPECT_FALSE(series.without_mesh());
    series.store(some_state(3));
    series.store(some_state(3));
  }
  const results::StateSeries again(folder / "");
  EXPECT_TRUE(again.without_mesh());
  EXPECT_EQ(again.states().size(), 2u);
  EXPECT_EQ(again.states()[1].elements, 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "results.xdmf"));
}

}  // namespace
}  // namespace polyslip
