#include "results/report/report.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "results/macro_csv.hpp"
#include "results/report/data.hpp"
#include "results/report/encode.hpp"
#include "results/report/macro_table.hpp"
#include "results/report/scene.hpp"
#include "results/report/surface.hpp"
#include "results/state_series.hpp"
#include "unit/results/fabricated.hpp"

namespace polyslip {
namespace {

using namespace results::report;
using nlohmann::json;
using tests::TemporaryFolder;

std::string gunzip(std::string packed, std::size_t size) {
  std::string bytes(size, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(size);
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

TEST(ReportEncoding, IsThatOfTheStandards) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
  std::string bytes(100000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i / 7);
  EXPECT_EQ(gunzip(gzip(bytes), bytes.size() + 1), bytes);
  EXPECT_EQ(gunzip(gzip(""), 1), "");
}

TEST(ReportSurface, HasEachBoundaryTriangleAndWhatLiesBehind) {
  constexpr int m = 2;
  const mesh::Mesh mesh = tests::two_grains(m);
  const Surface surface = surface_of(mesh);
  // Two triangles a square: 2 x 5 outer faces of m^2 squares each, and one between the grains.
  EXPECT_EQ(surface.triangles.size(), 11u * m * m * 2);
  EXPECT_EQ(surface.elements.size(), 12u * m * m * 2);
  std::size_t second = surface.triangles.size();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [inside, outside] = surface.grains[t];
    const int first = surface.elements[t];
    EXPECT_EQ(mesh.tetrahedron_cell[first] + 1, static_cast<int>(inside));
    if (outside > 0) {
      EXPECT_EQ(mesh.tetrahedron_cell[surface.elements[second++]] + 1, static_cast<int>(outside));
    }
    core::Vec3 x[3], middle = core::Vec3::Zero();
    for (int i = 0; i < 3; ++i) x[i] = mesh.nodes[surface.nodes[surface.triangles[t][i]]];
    for (int i = 0; i < 4; ++i) middle += 0.25 * mesh.nodes[mesh.tetrahedra[first][i]];
    EXPECT_GT((x[1] - x[0]).cross(x[2] - x[0]).dot(x[0] - middle), 0);
    // Lines of the topology run along the edges of the two cubes.
    for (int i = 0; i < 3; ++i) {
      const core::Vec3 a = x[i], b = x[(i + 1) % 3];
      int fixed = 0;
      for (int k = 0; k < 3; ++k) {
        const double end = k == 0 ? 2 : 1;
        fixed += std::abs(a[k] - b[k]) < 1e-12 &&
                 (a[k] < 1e-12 || a[k] > end - 1e-12 || (k == 0 && std::abs(a[k] - 1) < 1e-12));
      }
      EXPECT_EQ((surface.lines[t] >> i & 1) == 1, fixed == 2);
    }
  }
  EXPECT_EQ(second, surface.elements.size());
}

TEST(ReportSurface, RefusesATriangleWithNothingBehind) {
  mesh::Mesh mesh = tests::two_grains(1);
  std::swap(mesh.triangles.front()[0], mesh.triangles.back()[0]);
  EXPECT_THROW(surface_of(mesh), core::InternalError);
}

TEST(ReportValues, RangesLeaveOutWhatIsNotThere) {
  const double nan = std::nan("");
  const Range range = range_of({1, nan, 3}, {1, 100, 3});
  EXPECT_EQ(range.min, 1);
  EXPECT_EQ(range.max, 3);
  EXPECT_EQ(range.mean, 2.5);
  EXPECT_TRUE(std::isnan(range_of({nan}, {1}).mean));
}

TEST(ReportValues, SpreadIsTheAngleFromTheMeanOfTheGrain) {
  mesh::Snapshot s = tests::fabricated_snapshot(1, 0);
  auto& q = s.find("orientation")->values;
  // Halves of the first grain, of equal volume, turned by +-5 degrees about z; the second is whole.
  const double angle = 5 / core::degrees_per_radian;
  for (std::size_t p = 0; p < q.size() / 4; ++p) {
    const int element = static_cast<int>(p / 4), grain = s.mesh.tetrahedron_cell[element];
    const double turn = grain == 1 ? 0.7 : element % 2 == 0 ? angle : -angle;
    q[4 * p] = std::cos(turn / 2), q[4 * p + 3] = std::sin(turn / 2);
    q[4 * p + 1] = q[4 * p + 2] = 0;
  }
  const StateValues values = values_of(s);
  EXPECT_NEAR(std::abs(values.grain_orientation[0].w()), 1, 1e-12);
  EXPECT_NEAR(values.grain_volume[0], 1, 1e-12);
  for (int e = 0; e < s.mesh.element_count(); ++e)
    EXPECT_NEAR(values.values[5][e], s.mesh.tetrahedron_cell[e] == 0 ? 5 : 0, 1e-5);
}

TEST(ReportMacro, ReadsWholeRowsOnly) {
  const TemporaryFolder folder;
  tests::spit(folder / "macro.csv", "strain,sxx\n0.1,2e-3\n0.2,-1\n0.3");
  const MacroTable table = read_macro(folder / "macro.csv");
  EXPECT_EQ(table.names, (std::vector<std::string>{"strain", "sxx"}));
  EXPECT_EQ(table.columns[1], (std::vector<double>{2e-3, -1}));
  for (const char* row : {"0.1,abc\n", "0.1\n", "0.1,2,3\n", "0.1,\n"}) {
    tests::spit(folder / "macro.csv", std::string("strain,sxx\n") + row);
    EXPECT_THROW(read_macro(folder / "macro.csv"), core::InputError) << row;
  }
}

/// A run of two states, and a page to be filled.
class Report : public ::testing::Test {
 protected:
  Report() {
    std::filesystem::create_directories(folder_ / "run/results");
    results::StateSeries states(folder_ / "run");
    for (const double strain : {0.0, 0.25}) states.store(tests::fabricated_snapshot(1, strain));
    results::MacroCsv::create(folder_ / "run/macro.csv")
        .append({.strain = 0.25, .step_size = 0.25});
    tests::spit(folder_ / "run/deck.toml", "# </script> & more\n");
    tests::spit(page_,
                "<meta name=\"generator\" content=\"polyslip report\">\n"
                "<!-- the data of the run -->\n<p>end</p>");
  }
  std::string write(bool overwrite = false) {
    return write_report(
        {.sources = {.folder = folder_ / "run"}, .page = page_, .overwrite = overwrite});
  }
  std::string error() {
    try {
      write();
    } catch (const core::InputError& e) {
      return e.what();
    }
    return "";
  }

  TemporaryFolder folder_;
  std::string page_ = folder_ / "page.html";
};

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto begin = text.find(from);
  EXPECT_NE(begin, std::string::npos) << from;
  return text.substr(begin + from.size(), text.find(to, begin) - begin - from.size());
}

TEST_F(Report, HoldsTheStatesAndTheDeck) {
  const std::string html = tests::slurp(write());
  EXPECT_TRUE(html.ends_with("<p>end</p>"));
  const json data = json::parse(between(html, "id=\"report-data\">", "</script>"));
  EXPECT_EQ(data.at("schema"), "polyslip-report/1");
  EXPECT_EQ(data.at("title"), "run");
  EXPECT_EQ(data.at("deck"), "# </script> & more\n");
  EXPECT_TRUE(data.at("summary").is_null());
  EXPECT_EQ(data.at("macro").at("strain"), json({0.25}));
  ASSERT_EQ(data.at("states").size(), 2u);
  const mesh::Snapshot snapshot = tests::fabricated_snapshot(1, 0.25);
  const StateValues values = values_of(snapshot);
  const json& state = data.at("states")[1];
  EXPECT_EQ(state.at("strain"), 0.25);
  EXPECT_EQ(state.at("elements"), snapshot.mesh.element_count());
  EXPECT_EQ(state.at("values").at("g").at("mean"), range_of(values.values[0], values.volume).mean);
  const auto counts = state.at("quality").get<std::vector<long>>();
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0L), snapshot.mesh.element_count());
  EXPECT_EQ(state.at("grain_bunge").size(), 2u);
  EXPECT_EQ(data.at("texture").at("states").size(), 2u);
  EXPECT_EQ(data.at("spreads").at("states")[1].at("spread").size(), 2u);
  EXPECT_TRUE(data.at("taylor").is_null());
  // Both states have one mesh.
  EXPECT_EQ(state.at("mesh_block"), data.at("states")[0].at("mesh_block"));
  const Surface surface = surface_of(snapshot.mesh);
  EXPECT_EQ(between(html, "id=\"mesh-000\">", "</script>"), base64(gzip(mesh_block(surface))));
  EXPECT_EQ(mesh_block(surface).size(), 21 * surface.triangles.size());
}

TEST_F(Report, ReplacesReportsOnly) {
  write();
  EXPECT_NO_THROW(write());
  tests::spit(folder_ / "run/report.html", "mine");
  EXPECT_NE(error().find("report.html: is not a report of ours"), std::string::npos) << error();
  EXPECT_EQ(tests::slurp(folder_ / "run/report.html"), "mine");
  EXPECT_NO_THROW(write(true));
}

TEST_F(Report, SaysWhatIsMissing) {
  page_ = folder_ / "none.html";
  EXPECT_NE(error().find("built without the page of its reports"), std::string::npos) << error();
  page_ = folder_ / "page.html";
  tests::spit(page_, "another page");
  EXPECT_NE(error().find("is not the page of a report"), std::string::npos) << error();
  EXPECT_THROW(gather({.folder = folder_ / "nowhere"}), core::InputError);
}

TEST(ReportScene, PositionsAndValuesComeBackToTheirLastDigit) {
  const mesh::Snapshot s = tests::fabricated_snapshot(2, 0.3);
  const Surface surface = surface_of(s.mesh);
  const StateValues values = values_of(s);
  std::array<Range, quantity_count> ranges;
  for (std::size_t k = 0; k < quantity_count; ++k)
    ranges[k] = range_of(values.values[k], values.volume);
  const Box box = box_of(surface, s.mesh);
  const std::string block = state_block(surface, s.mesh, box, values, ranges);
  const std::size_t nodes = surface.nodes.size(), sides = surface.elements.size();
  ASSERT_EQ(block.size(), 6 * nodes + 3 * sides + sides % 2 + 2 * quantity_count * sides);
  const auto number = [&](std::size_t byte) {
    return static_cast<unsigned char>(block[byte]) +
           256 * static_cast<unsigned char>(block[byte + 1]);
  };
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t n = 0; n < nodes; ++n) {
      const double size = box.high[i] - box.low[i];
      EXPECT_NEAR(box.low[i] + size * number(2 * (i * nodes + n)) / 65534,
                  s.mesh.nodes[surface.nodes[n]][i], size / 65534);
    }
  const std::size_t first = 6 * nodes + 3 * sides + sides % 2;
  for (std::size_t k = 0; k < quantity_count; ++k)
    for (std::size_t side = 0; side < sides; ++side) {
      const double size = ranges[k].max - ranges[k].min;
      EXPECT_NEAR(ranges[k].min + size * number(first + 2 * (k * sides + side)) / 65534,
                  values.values[k][surface.elements[side]], size / 65534);
    }
}

}  // namespace
}  // namespace polyslip
