#include "mesh/tess_reader.hpp"

#include <fmt/format.h>

#include "core/random.hpp"
#include "core/rotation.hpp"
#include "mesh/tess_writer.hpp"
#include "unit/mesh/reader_support.hpp"

namespace polyslip::mesh {
namespace {

const std::string neper_file = POLYSLIP_SOURCE_DIR "/tests/data/n20-id1-raw.tess";

std::string fault(const std::string& text) {
  return fault_of("fault.tess", text, [](const std::string& path) { read_tess(path); });
}

Tessellation grown(double l_max) {
  auto t = voronoi_tessellation({.grains = 25, .seed = 3, .domain = {1, 2, 0.7}});
  regularise(t, {.max_edge_length = l_max});
  return t;
}

void expect_same(const Tessellation& a, const Tessellation& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.seeds, b.seeds);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.topology.cell_faces, b.topology.cell_faces);
  ASSERT_EQ(a.topology.edges.size(), b.topology.edges.size());
  for (std::size_t e = 0; e < a.topology.edges.size(); ++e)
    EXPECT_EQ(a.topology.edges[e].vertices, b.topology.edges[e].vertices);
  ASSERT_EQ(a.topology.faces.size(), b.topology.faces.size());
  for (std::size_t f = 0; f < a.topology.faces.size(); ++f) {
    const auto &p = a.topology.faces[f], &q = b.topology.faces[f];
    EXPECT_EQ(p.edges, q.edges);
    EXPECT_EQ(p.forward, q.forward);
    EXPECT_EQ(p.cells, q.cells);
    EXPECT_EQ(p.domain_face, q.domain_face);
    EXPECT_EQ(a.face_planes[f].normal, b.face_planes[f].normal);
    EXPECT_EQ(a.face_planes[f].offset, b.face_planes[f].offset);
  }
  EXPECT_EQ(a.face_masters, b.face_masters);
}

TEST(TessReader, OurOwnFilesComeBackBitForBit) {
  for (const double l_max : {0.0, 0.13, 0.3}) {
    const Tessellation t = grown(l_max);
    const TemporaryFile file("own.tess", "");
    write_tess(t, file.path());
    const TessellationFile read = read_tess(file.path());
    ASSERT_NO_THROW(read.tessellation.check());
    EXPECT_FALSE(read.orientations);
    expect_same(read.tessellation, t);
    for (int c = 0; c < 25; ++c)
      EXPECT_NEAR(cell_volume(read.tessellation, c), cell_volume(t, c), 1e-8);
    const std::string text = core::read_text(file.path());
    write_tess(read.tessellation, file.path());
    EXPECT_EQ(core::read_text(file.path()), text);
  }
}

TEST(TessReader, RegularisingAgainWhatWasReadChangesNothing) {
  for (const double l_max : {0.13, 0.3}) {
    const Tessellation t = grown(l_max);
    const TemporaryFile file("again.tess", "");
    write_tess(t, file.path());
    Tessellation again = read_tess(file.path()).tessellation;
    const RegularisationReport report = regularise(again, {.max_edge_length = l_max});
    EXPECT_EQ(report.deleted, 0);
    expect_same(again, t);
  }
}

TEST(TessReader, NotesOnCellsComeBack) {
  const Tessellation t = grown(0.13);
  core::Random random(2, core::Stream::tests);
  std::vector<core::Quaternion> orientations;
  std::vector<int> ids, groups;
  std::vector<double> weights;
  for (int c = 0; c < 25; ++c) {
    orientations.push_back(random.rotation());
    ids.push_back(100 - 3 * c);
    groups.push_back(1 + c % 2);
    weights.push_back(random.uniform());
  }
  const TemporaryFile file("notes.tess", "");
  write_tess(t, file.path(),
             {.orientations = orientations,
              .ids = ids,
              .seed_weights = weights,
              .groups = groups,
              .crystal = "cubic"});
  const TessellationFile read = read_tess(file.path());
  expect_same(read.tessellation, t);
  EXPECT_EQ(read.cell_ids, ids);
  EXPECT_EQ(read.seed_weights, weights);
  EXPECT_EQ(read.crystal, "cubic");
  ASSERT_TRUE(read.groups && read.orientations);
  EXPECT_EQ(*read.groups, groups);
  for (std::size_t c = 0; c < 25; ++c)
    EXPECT_LT(core::rotation_angle(read.orientations->at(c).conjugate() * orientations[c]), 1e-15);
  const std::string text = core::read_text(file.path());
  EXPECT_EQ(fault(replaced(text, " 100 97 ", " 97 97 ")), "9: two cells have the id 97");
  EXPECT_EQ(fault(replaced(text, " 100 97 ", " 0 97 ")), "9: the id of a cell is 0, not positive");
}

/// A prism of `sides` sides about z, all of them one surface, and its ends.
Domain prism(int sides, double turn) {
  std::vector<Plane> planes{{{0, 0, -1}, 0}, {{0, 0, 1}, 1.5}};
  std::vector<std::string> names{"z0", "z1"};
  for (int i = 0; i < sides; ++i) {
    const double angle = turn + 2 * 3.14159265358979 * i / sides;
    planes.push_back({{std::cos(angle), std::sin(angle), 0}, 1});
    names.push_back("side");
  }
  return convex_domain("cylinder", planes, names, 20);
}

TEST(TessReader, ConvexDomainsComeBack) {
  for (const int sides : {3, 24}) {
    const Domain domain = prism(sides, 0.1);
    core::Random random(9, core::Stream::tests);
    std::vector<core::Vec3> seeds;
    while (seeds.size() < 20) {
      const core::Vec3 x = core::Vec3(random.uniform(), random.uniform(), random.uniform())
                               .cwiseProduct(domain.size);
      if (std::all_of(domain.faces.begin(), domain.faces.end(),
                      [&](const DomainFace& f) { return f.plane.normal.dot(x) < f.plane.offset; }))
        seeds.push_back(x);
    }
    Tessellation t = voronoi_tessellation(seeds, domain);
    regularise(t, {.max_edge_length = 0.13});
    const TemporaryFile file("domain.tess", "");
    write_tess(t, file.path());
    const TessellationFile read = read_tess(file.path());
    const Tessellation& back = read.tessellation;
    EXPECT_FALSE(back.domain.is_box());
    EXPECT_EQ(back.domain.shape, "cylinder");
    EXPECT_EQ(back.domain.face_count(), sides + 2);
    EXPECT_EQ(back.domain.surface_names(), (std::vector<std::string>{"z0", "z1", "side"}));
    EXPECT_NEAR(back.domain.volume, 20, 1e-12);
    ASSERT_EQ(back.vertices.size(), t.vertices.size());
    for (std::size_t v = 0; v < t.vertices.size(); ++v)
      EXPECT_LT((back.vertices[v] - t.vertices[v]).norm(), 1e-12);
    for (std::size_t f = 0; f < t.topology.faces.size(); ++f)
      EXPECT_EQ(back.topology.faces[f].domain_face, t.topology.faces[f].domain_face);
    // Moved and twice as large, it is the same.
    Tessellation moved = t;
    const core::Vec3 shift(-3, 0.5, 7);
    for (auto& x : moved.vertices) x = 2 * x + shift;
    for (auto& x : moved.seeds) x = 2 * x + shift;
    for (auto& p : moved.face_planes) p.offset = 2 * p.offset + p.normal.dot(shift);
    for (auto& f : moved.domain.faces)
      f.plane.offset = 2 * f.plane.offset + f.plane.normal.dot(shift);
    write_tess(moved, file.path());
    const TessellationFile again = read_tess(file.path());
    EXPECT_NEAR(again.scale, 0.5, 1e-12);
    EXPECT_LT((again.origin - shift).norm(), 1e-12);
    for (std::size_t v = 0; v < t.vertices.size(); ++v)
      EXPECT_LT((again.tessellation.vertices[v] - t.vertices[v]).norm(), 1e-11);
    EXPECT_NEAR(read_tess(file.path(), LengthUnit::file).tessellation.domain.volume, 160, 1e-9);
  }
}

TEST(TessReader, ReadsATessellationOfNeper) {
  const TessellationFile read = read_tess(neper_file);
  const Tessellation& t = read.tessellation;
  ASSERT_NO_THROW(t.check());
  EXPECT_EQ(t.topology.cell_count(), 20);
  EXPECT_EQ(t.topology.faces.size(), 127U);
  EXPECT_EQ(t.topology.edges.size(), 216U);
  EXPECT_EQ(t.topology.vertex_count, 110);
  EXPECT_EQ(t.vertices[1], core::Vec3(1.674209429732, 1.625785997561, 0.629863637027));
  EXPECT_EQ(t.seeds[19], core::Vec3(0.208175605311, 1.643347685083, 0.611914386012));
  ASSERT_TRUE(read.orientations);
  ASSERT_EQ(read.orientations->size(), 20U);
  const core::Vec3 r = core::to_rodrigues(read.orientations->front());
  EXPECT_LT((r - core::Vec3(0.072386045838, 0.073015604202, -0.306901446481)).norm(), 1e-15);
  // Faces between cells lie half way between the seeds; planes say so, and point outwards.
  for (std::size_t f = 0; f < t.topology.faces.size(); ++f) {
    const auto& cells = t.topology.faces[f].cells;
    if (cells[1] < 0) continue;
    const core::Vec3 &a = t.seeds[cells[0]], &b = t.seeds[cells[1]];
    EXPECT_GT(t.face_planes[f].normal.dot((b - a).normalized()), 1 - 1e-9);
    EXPECT_NEAR(t.face_planes[f].normal.dot((a + b) / 2), t.face_planes[f].offset, 1e-9);
  }
}

TEST(TessReader, WhatNeperMadeIsOurVoronoiTessellationOfItsSeeds) {
  const Tessellation read = read_tess(neper_file).tessellation;
  const Tessellation ours = voronoi_tessellation(read.seeds, read.size);
  EXPECT_EQ(read.topology.vertex_count, ours.topology.vertex_count);
  for (int c = 0; c < 20; ++c) EXPECT_NEAR(cell_volume(read, c), cell_volume(ours, c), 1e-9);
}

TEST(TessReader, WhatNeperMadeCanBeRegularised) {
  Tessellation t = read_tess(neper_file).tessellation;
  const auto report = regularise(t, {});
  EXPECT_GT(report.deleted, 10);
  EXPECT_NO_THROW(t.check());
}

TEST(TessReader, MovesAndScalesToTheBoxOfUnitGrains) {
  const Tessellation t = grown(0.13);
  Tessellation moved = t;
  const core::Vec3 shift(-3, 0.5, 7);
  for (auto& x : moved.vertices) x = 2 * x + shift;
  for (auto& x : moved.seeds) x = 2 * x + shift;
  for (auto& p : moved.face_planes) p.offset = 2 * p.offset + p.normal.dot(shift);
  moved.size *= 2;
  const TemporaryFile file("moved.tess", "");
  write_tess(moved, file.path());
  const Tessellation read = read_tess(file.path()).tessellation;
  EXPECT_LT((read.size - t.size).norm(), 1e-12);
  for (std::size_t v = 0; v < t.vertices.size(); ++v)
    EXPECT_LT((read.vertices[v] - t.vertices[v]).norm(), 1e-12);
  for (std::size_t c = 0; c < t.seeds.size(); ++c)
    EXPECT_LT((read.seeds[c] - t.seeds[c]).norm(), 1e-12);
  for (std::size_t f = 0; f < t.face_planes.size(); ++f)
    EXPECT_NEAR(read.face_planes[f].offset, t.face_planes[f].offset, 1e-12);
}

// Face 1 written the other way round, on the outside of its only cell, or turned by one edge.
TEST(TessReader, AFaceMayPointInwardsAndItsEdgesMayBeginElsewhere) {
  const std::string text = core::read_text(neper_file);
  const auto faces = text.find("**face");
  const auto at = text.find("   1 ", faces);
  const auto end = text.find("\n   2 ", at);
  const std::string face = text.substr(at, end - at);
  const Tessellation expected = read_tess(neper_file).tessellation;
  const auto loop = expected.topology.face_vertices(0);
  const auto& f = expected.topology.faces[0];
  ASSERT_EQ(f.cells[1], -1);
  const int n = static_cast<int>(loop.size());
  std::string turned = fmt::format("   1 {}", n), reversed = turned;
  std::string edges = fmt::format("\n {}", n), back = edges;
  for (int i = 0; i < n; ++i) {
    turned += fmt::format(" {}", loop[i] + 1);
    reversed += fmt::format(" {}", loop[n - 1 - i] + 1);
    const int next = (i + 1) % n, last = (2 * n - 2 - i) % n;
    edges += fmt::format(" {}", (f.forward[next] ? 1 : -1) * (f.edges[next] + 1));
    back += fmt::format(" {}", (f.forward[last] ? -1 : 1) * (f.edges[last] + 1));
  }
  const auto& plane = expected.face_planes[0];
  const auto tail = [&](double s) {
    return fmt::format("\n {} {} {} {}\n 0 0 0 0 0", s * plane.offset, s * plane.normal[0],
                       s * plane.normal[1], s * plane.normal[2]);
  };
  {
    const TemporaryFile file("turned.tess", replaced(text, face, turned + edges + tail(1)));
    expect_same(read_tess(file.path()).tessellation, expected);
  }
  std::string inwards = replaced(text, face, reversed + back + tail(-1));
  const auto cell = inwards.find("**polyhedron");
  const std::string head = inwards.substr(0, cell);
  inwards = head + replaced(inwards.substr(cell), " 1 2 ", " -1 2 ");
  const TemporaryFile file("inwards.tess", inwards);
  const Tessellation read = read_tess(file.path()).tessellation;
  ASSERT_NO_THROW(read.check());
  EXPECT_EQ(read.topology.faces[0].cells, f.cells);
  EXPECT_EQ(read.face_planes[0].normal, plane.normal);
}

TEST(TessReader, SaysWhereAFileIsWrong) {
  const std::string text = core::read_text(neper_file);
  EXPECT_EQ(fault(""), "1: the file ends where ***tess should be");
  EXPECT_EQ(fault("hello"), "1: 'hello' where ***tess should be");
  EXPECT_EQ(fault(text.substr(0, text.find("***end"))),
            "1036: the file ends where ***end should be");
  EXPECT_NE(fault(text.substr(0, text.find("**polyhedron"))).find("the file ends where"),
            std::string::npos);
  EXPECT_EQ(fault(replaced(text, "**edge", "**hedge")), "165: '**hedge' where **edge should be");
  EXPECT_EQ(fault(replaced(text, "1.674209429732", "nan")),
            "56: a coordinate of a vertex is nan, not finite");
  EXPECT_EQ(fault(replaced(text, "1.674209429732", "1.67x")),
            "56: '1.67x' should be a coordinate of a vertex, a number");
  EXPECT_EQ(fault(replaced(text, "   3.5", "   2.0")),
            "3: version '2.0' of the format; 3 and later are read");
  EXPECT_EQ(fault(replaced(text, "3 standard", "3 folded")),
            "5: type 'folded'; standard and periodic are read");
  EXPECT_EQ(fault(replaced(text, "rodrigues:passive", "quaternion:active")),
            "34: a quaternion of length 0.328229, not 1");
  EXPECT_NE(fault(replaced(text, "rodrigues:passive", "rodriguez"))
                .find("32: orientations are 'rodriguez'; read are rodrigues, "),
            std::string::npos);
  EXPECT_EQ(fault(replaced(text, "**vertex\n 110", "**vertex\n 99999999")),
            "54: the number of vertices is 99999999, which the rest of the file cannot hold");
  EXPECT_NE(fault(replaced(text, "1.674209429732", "2.9")), "");
}

TEST(TessReader, RefusesFacesThatLeaveTheirDomain) {
  Tessellation t = grown(0.0);
  for (auto& x : t.vertices) x[0] += 0.1 * x[2];
  const TemporaryFile file("sheared.tess", "");
  write_tess(t, file.path());
  const std::string text = core::read_text(file.path());
  EXPECT_NE(fault(text).find(" off the face x0 of the domain"), std::string::npos) << fault(text);
  const std::string bare = text.substr(0, text.find(" **domain")) + "***end\n";
  EXPECT_NE(fault(bare).find("lies neither on a side of the vertices' bounding box nor in a face "
                             "of **domain"),
            std::string::npos)
      << fault(bare);
}

TEST(TessReader, AFileThatIsNotThereIsTheUsersToMend) {
  EXPECT_THROW(read_tess("/no/such/file.tess"), core::InputError);
}

}  // namespace
}  // namespace polyslip::mesh
