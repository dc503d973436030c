#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/file.hpp"
#include "mesh/tessellation.hpp"

namespace polyslip::mesh {
namespace {

/// Lines after a heading such as " **vertex", up to the next heading.
std::vector<std::string> section(const std::string& text, const std::string& heading) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const bool is_heading = line.find('*') != std::string::npos;
    if (inside && is_heading) break;
    if (inside) lines.push_back(line);
    if (line == heading) inside = true;
  }
  return lines;
}

std::vector<double> numbers(const std::string& line) {
  std::istringstream in(line);
  std::vector<double> values;
  for (double v; in >> v;) values.push_back(v);
  return values;
}

class TessFile : public testing::Test {
 protected:
  void SetUp() override {
    PolycrystalOptions options;
    options.grains = 25;
    tessellation_ = voronoi_tessellation(options);
    regularise(tessellation_, RegularisationOptions{});

    path_ = testing::TempDir() + "polyslip_tess_test-" + std::to_string(getpid()) + ".tess";
    write_tess(tessellation_, path_);
    text_ = core::read_text(path_);
  }
  void TearDown() override { std::filesystem::remove(path_); }

  Tessellation tessellation_;
  std::string path_, text_;
};

TEST_F(TessFile, StartsAndEndsAsTheFormatSays) {
  EXPECT_EQ(
      text_.rfind("***tess\n **format\n   3.5\n **general\n   3 standard\n **cell\n  25\n", 0), 0U);
  EXPECT_EQ(text_.substr(text_.size() - 7), "***end\n");
}

TEST_F(TessFile, VerticesComeBackBitForBit) {
  const auto lines = section(text_, " **vertex");
  ASSERT_EQ(lines.size(), tessellation_.vertices.size() + 1);
  for (std::size_t i = 0; i < tessellation_.vertices.size(); ++i) {
    const auto row = numbers(lines[i + 1]);
    ASSERT_EQ(row.size(), 5U);
    EXPECT_EQ(row[0], static_cast<double>(i + 1));
    EXPECT_EQ(core::Vec3(row[1], row[2], row[3]), tessellation_.vertices[i]);
  }
}

TEST_F(TessFile, SignedEdgesCloseEachFace) {
  const auto edge_lines = section(text_, " **edge");
  const auto lines = section(text_, " **face");
  const auto n = tessellation_.topology.faces.size();
  ASSERT_EQ(lines.size(), 4 * n + 1);
  int moved = 0;
  for (std::size_t f = 0; f < n; ++f) {
    const auto vertices = numbers(lines[4 * f + 1]), edges = numbers(lines[4 * f + 2]);
    const auto k = static_cast<std::size_t>(vertices[1]);
    ASSERT_EQ(vertices.size(), k + 2);
    ASSERT_EQ(edges.size(), k + 1);
    for (std::size_t i = 0; i < k; ++i) {
      const double e = edges[i + 1];
      const auto ends = numbers(edge_lines[static_cast<std::size_t>(std::abs(e))]);
      EXPECT_EQ(vertices[2 + i], ends[e > 0 ? 1 : 2]);
      EXPECT_EQ(vertices[2 + (i + 1) % k], ends[e > 0 ? 2 : 1]);
    }
    ASSERT_EQ(numbers(lines[4 * f + 3]).size(), 4U);
    const auto point = numbers(lines[4 * f + 4]);
    ASSERT_EQ(point.size(), 5U);
    moved += point[0] == 1;
    EXPECT_LE(point[1], static_cast<double>(k));
  }
  EXPECT_GT(moved, 10);
}

TEST_F(TessFile, DomainListsEveryBoundaryFaceAndCornerOnce) {
  std::set<std::string> corners;
  const auto domain = text_.substr(text_.find(" **domain"));
  for (const auto& line : section(domain, "  *vertex"))
    if (line.find('x') != std::string::npos) corners.insert(line.substr(line.find('x')));
  EXPECT_EQ(corners, (std::set<std::string>{"x0y0z0", "x0y0z1", "x0y1z0", "x0y1z1", "x1y0z0",
                                            "x1y0z1", "x1y1z0", "x1y1z1"}));
  const auto lines = section(domain, "  *face");
  ASSERT_EQ(lines.size(), 1 + 6 * 6U);
  std::map<int, int> seen;
  for (int b = 0; b < 6; ++b) {
    EXPECT_NE(lines[5 + 6 * b].find(box_face_names[b]), std::string::npos);
    const auto ids = numbers(lines[6 + 6 * b]);
    for (std::size_t i = 1; i < ids.size(); ++i) {
      ++seen[static_cast<int>(ids[i])];
      EXPECT_EQ(tessellation_.topology.faces[static_cast<std::size_t>(ids[i]) - 1].domain_face, b);
    }
  }
  int expected = 0;
  for (const auto& face : tessellation_.topology.faces) expected += face.domain_face >= 0;
  EXPECT_EQ(static_cast<int>(seen.size()), expected);
}

TEST(TessFileErrors, AnUnwritablePathIsTheUsersToMend) {
  PolycrystalOptions options;
  options.grains = 1;
  EXPECT_THROW(write_tess(voronoi_tessellation(options), "/no/such/folder/a.tess"),
               core::InputError);
}

}  // namespace
}  // namespace polyslip::mesh
