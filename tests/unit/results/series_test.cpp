#include <gtest/gtest.h>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "results/schema.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"

namespace polyslip {
namespace {

using results::StateSeries;
using tests::fabricated_snapshot;

struct RunFolder : tests::TemporaryFolder {
  RunFolder() { std::filesystem::create_directory(*this / "results"); }
};

int count(const std::string& text, const std::string& word) {
  int n = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

void store_four(const std::string& folder) {
  StateSeries series(folder);
  series.store(fabricated_snapshot(1, 0));
  series.store(fabricated_snapshot(1, 0.3));
  series.store(fabricated_snapshot(2, 0.3, 1));
  series.store(fabricated_snapshot(2, 0.6, 1));
}

TEST(StateSeries, GoesOnWhereTheIndexEnds) {
  const RunFolder folder;
  store_four(folder.path());
  StateSeries again(folder.path());
  ASSERT_EQ(again.states().size(), 4u);
  EXPECT_EQ(again.states()[2].mesh_number, 1);
  EXPECT_EQ(again.states()[2].strain, 0.3);
  EXPECT_EQ(again.store(fabricated_snapshot(1, 0.7)).file, "state-0004.h5");
  EXPECT_EQ(results::read_state(folder / "results/state-0002.h5").mesh.element_count(), 96);
}

TEST(StateSeries, XdmfNamesEveryStateWithItsOwnMesh) {
  const RunFolder folder;
  store_four(folder.path());
  const std::string xdmf = tests::slurp(folder / "results.xdmf");
  EXPECT_EQ(count(xdmf, "<Time "), 4);
  EXPECT_EQ(count(xdmf, "TopologyType=\"Tetrahedron_10\" NumberOfElements=\"12\""), 2);
  EXPECT_EQ(count(xdmf, "TopologyType=\"Tetrahedron_10\" NumberOfElements=\"96\""), 2);
  EXPECT_EQ(count(xdmf, "<Time Value=\"0.3\"/>"), 1);
  EXPECT_EQ(count(xdmf, "<Time Value=\"0.3000000003\"/>"), 1);
  EXPECT_EQ(count(xdmf, "<DataItem"), count(xdmf, "</DataItem>"));
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(count(xdmf, "results/state-000" + std::to_string(i) + ".h5:/mesh/nodes"), 1);
}

TEST(StateSeries, XdmfDimensionsAreTheDatasets) {
  const RunFolder folder;
  StateSeries series(folder.path());
  series.store(fabricated_snapshot(1, 0.1));
  const std::string xdmf = tests::slurp(folder / "results.xdmf");
  const auto file = results::hdf5::File::open(folder / "results/state-0000.h5");
  int items = 0;
  for (auto at = xdmf.find("Dimensions=\""); at != std::string::npos;
       at = xdmf.find("Dimensions=\"", at + 1), ++items) {
    std::istringstream sizes(xdmf.substr(at + 12, xdmf.find('"', at + 12) - at - 12));
    std::vector<std::uint64_t> shape;
    for (std::uint64_t size = 0; sizes >> size;) shape.push_back(size);
    const auto colon = xdmf.find(".h5:/", at) + 5;
    const std::string name = xdmf.substr(colon, xdmf.find('<', colon) - colon);
    EXPECT_EQ(file.shape(name, results::dataset_spec(name).type), shape) << name;
  }
  EXPECT_EQ(items, 11);
}

TEST(StateSeries, TrimsStatesOfAfterTheCheckpoint) {
  const RunFolder folder;
  store_four(folder.path());
  tests::spit(folder / "results/state-0004.h5.part", "half");
  tests::spit(folder / "results/state-0004.h5", "not in the index yet");
  tests::spit(folder / "results/notes.txt", "mine");
  StateSeries series(folder.path());
  series.keep_first(2);
  EXPECT_EQ(series.states().size(), 2u);
  EXPECT_EQ(StateSeries(folder.path()).states().size(), 2u);
  EXPECT_TRUE(std::filesystem::exists(folder / "results/state-0001.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/state-0002.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/state-0004.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/state-0004.h5.part"));
  EXPECT_TRUE(std::filesystem::exists(folder / "results/notes.txt"));
  EXPECT_EQ(count(tests::slurp(folder / "results.xdmf"), "<Time "), 2);
  EXPECT_THROW(series.keep_first(3), core::InputError);
}

TEST(StateSeries, TrimsByStrain) {
  const RunFolder folder;
  store_four(folder.path());
  StateSeries series(folder.path());
  series.trim_after(0.3);
  EXPECT_EQ(series.states().size(), 3u);
  series.trim_after(0.1);
  EXPECT_EQ(series.states().size(), 1u);
}

TEST(StateSeries, NearestState) {
  const RunFolder folder;
  EXPECT_THROW(results::nearest_state(StateSeries(folder.path()), 0.1), core::InputError);
  EXPECT_THROW(results::begun_series(folder.path()), core::InputError);
  store_four(folder.path());
  const StateSeries series(folder.path());
  EXPECT_EQ(results::nearest_state(series, 0.31).file, "state-0001.h5");
  EXPECT_EQ(results::nearest_state(series, 5).file, "state-0003.h5");
}

TEST(StateSeries, DamagedIndexIsOneLine) {
  const RunFolder folder;
  for (const char* text : {"", "{", "[]", "{\"schema\":\"polyslip-index/1\"}", "{\"schema\":7}"}) {
    tests::spit(folder / "results/index.json", text);
    EXPECT_THROW(StateSeries(folder.path()), core::InputError) << text;
  }
}

}  // namespace
}  // namespace polyslip
