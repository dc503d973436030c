#include "mesh/msh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "core/rotation.hpp"
#include "mesh/geometry.hpp"
#include "support/box_mesh.hpp"
#include "unit/mesh/reader_support.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

std::string text_of(const Mesh& mesh) {
  const TemporaryFile file("text.msh", "");
  write_msh(mesh, file.path());
  return core::read_text(file.path());
}

MeshFile read_text_of(const std::string& text, LengthUnit unit = LengthUnit::grain) {
  const TemporaryFile file("read.msh", text);
  return read_msh(file.path(), unit);
}

std::string fault(const std::string& text) {
  return fault_of("fault.msh", text, [](const std::string& path) { read_msh(path); });
}

Mesh two_slabs() { return tests::box_mesh({4, 2, 2}, {2, 1, 1}, 2); }

void expect_same_counts(const Topology& a, const Topology& b) {
  EXPECT_EQ(a.cell_count(), b.cell_count());
  EXPECT_EQ(a.faces.size(), b.faces.size());
  EXPECT_EQ(a.edges.size(), b.edges.size());
  EXPECT_EQ(a.vertex_count, b.vertex_count);
}

/// Pairs of cells, and faces of the box, that the faces lie between.
std::vector<std::array<int, 3>> sides(const Topology& t) {
  std::vector<std::array<int, 3>> found;
  for (const auto& f : t.faces) {
    auto cells = f.cells;
    if (cells[1] >= 0) std::sort(cells.begin(), cells.end());
    found.push_back({cells[0], cells[1], f.domain_face});
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(MshReader, FindsTheTopologyOfSlabs) {
  Mesh mesh = two_slabs();
  tests::distort(mesh, 0.05);
  const MeshFile read = read_text_of(text_of(mesh));
  ASSERT_NO_THROW(check(read.mesh));
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  EXPECT_EQ(read.mesh.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(read.mesh.tetrahedron_cell, mesh.tetrahedron_cell);
  EXPECT_EQ(read.mesh.size, mesh.size);
  EXPECT_EQ(read.grain_ids, (std::vector<int>{1, 2}));
  EXPECT_FALSE(read.orientations);
  EXPECT_EQ(read.mesh.topology.cell_count(), 2);
  EXPECT_EQ(read.mesh.topology.faces.size(), 11U);
  EXPECT_EQ(read.mesh.topology.edges.size(), 20U);
  EXPECT_EQ(read.mesh.topology.vertex_count, 12);
  EXPECT_EQ(sides(read.mesh.topology), sides(mesh.topology));
  EXPECT_EQ(read.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(read.mesh.lines.size(), mesh.lines.size());
}

TEST(MshReader, FindsTheTopologyOfAPolycrystal) {
  const auto pool = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  auto tessellation = voronoi_tessellation({.grains = 12, .seed = 5});
  regularise(tessellation, RegularisationOptions{}.as_in_the_paper());
  for (const int order : {1, 2}) {
    MeshingOptions options;
    options.element_size = 0.8;
    options.order = order;
    options.meshers = {"gmsh-hxt"};
    MeshingReport report;
    const Mesh mesh =
        mesh_geometry(geometry_of(tessellation), options, Vec3::Ones(), *pool, report);
    const MeshFile read = read_text_of(text_of(mesh));
    ASSERT_NO_THROW(check(read.mesh));
    EXPECT_EQ(read.mesh.order, order);
    EXPECT_EQ(read.mesh.nodes, mesh.nodes);
    EXPECT_EQ(read.mesh.tetrahedra, mesh.tetrahedra);
    expect_same_counts(read.mesh.topology, tessellation.topology);
    EXPECT_EQ(sides(read.mesh.topology), sides(tessellation.topology));
    EXPECT_EQ(text_of(read_text_of(text_of(read.mesh)).mesh), text_of(read.mesh));
    if (order == 2) {
      const Mesh again =
          mesh_geometry(geometry_of(read.mesh), options, Vec3::Ones(), *pool, report);
      EXPECT_NO_THROW(check(again));
      const auto volumes = grain_volumes(mesh), after = grain_volumes(again);
      for (std::size_t c = 0; c < volumes.size(); ++c) EXPECT_NEAR(after[c], volumes[c], 1e-3);
    }
  }
}

/// As other programs write: sections that are not ours, three tags, lower elements, grains in no
/// order and with gaps in their numbers, nodes that nothing uses, orientations.
std::string foreign(const std::string& own) {
  std::istringstream in(own);
  std::string out, elements, line;
  int count = 0, nodes = 0;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line == "$PhysicalNames")
      out += "$Domain\ncube\n$EndDomain\n$NSets\n1\nx0\n1\n1\n$EndNSets\n";
    if (line == "$Nodes") {
      std::getline(in, line);
      nodes = std::stoi(line);
      out += fmt::format("$Nodes\n{}\n{} 0.5 0.5 0.5\n", nodes + 1, nodes + 7);
      continue;
    }
    if (line == "$Elements") {
      inside = true;
      std::getline(in, line);
      continue;
    }
    if (line == "$EndElements") break;
    if (!inside) {
      out += line + "\n";
      continue;
    }
    std::istringstream words(line);
    int id = 0, type = 0, tags = 0, physical = 0, elementary = 0;
    words >> id >> type >> tags >> physical >> elementary;
    std::string rest;
    std::getline(words, rest);
    // The second grain comes first, as 3; the first is 8.
    const int grain = physical == 1 ? 8 : 3;
    const std::string made = fmt::format("{} {} 3 {} {} 0{}\n", id + 1, type, grain, grain, rest);
    elements = grain == 3 ? made + elements : elements + made;
    ++count;
  }
  return out + fmt::format("$Elements\n{}\n1 15 2 1 1 1\n", count + 1) + elements +
         "$EndElements\n$ElsetOrientations\n2 rodrigues:passive\n8 0.1 0.2 -0.3\n3 0 0 0.25\n"
         "$EndElsetOrientations\n";
}

TEST(MshReader, ReadsForeignFilesAndRemembersTheirOrder) {
  const Mesh mesh = two_slabs();
  const std::string text = foreign(text_of(mesh));
  const MeshFile read = read_text_of(text);
  ASSERT_NO_THROW(check(read.mesh));
  EXPECT_EQ(read.grain_ids, (std::vector<int>{3, 8}));
  EXPECT_EQ(read.mesh.nodes, mesh.nodes);
  const int half = mesh.element_count() / 2;
  ASSERT_EQ(read.mesh.element_count(), 2 * half);
  ASSERT_EQ(static_cast<int>(read.file_rows.size()), 2 * half);
  // Domain triangles of the file lie between; rows count tetrahedra only.
  for (int e = 0; e < 2 * half; ++e) EXPECT_EQ(read.file_rows[e], e);
  for (int e = 0; e < half; ++e) {
    EXPECT_EQ(read.mesh.tetrahedra[e], mesh.tetrahedra[2 * half - 1 - e]);
    EXPECT_EQ(read.mesh.tetrahedra[half + e], mesh.tetrahedra[e]);
  }
  ASSERT_TRUE(read.orientations);
  EXPECT_LT((core::to_rodrigues(read.orientations->at(0)) - Vec3(0, 0, 0.25)).norm(), 1e-15);
  EXPECT_LT((core::to_rodrigues(read.orientations->at(1)) - Vec3(0.1, 0.2, -0.3)).norm(), 1e-15);
  EXPECT_NE(fault(replaced(text, "\n3 0 0 0.25", "\n4 0 0 0.25")).find("grain 3 has no line"),
            std::string::npos);
}

TEST(MshReader, RowsLeadBackToTheFileWhereGrainsAreMixed) {
  const Mesh mesh = two_slabs();
  std::string text = text_of(mesh);
  const int n = mesh.element_count();
  // The first and the last tetrahedron change places.
  const auto begin = text.find("\n1 11 2 1 1 "), end = text.find('\n', begin + 1);
  const auto last = text.find(fmt::format("\n{} 11 2 2 2 ", n)),
             last_end = text.find('\n', last + 1);
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  text = text.substr(0, begin) + text.substr(last, last_end - last) + text.substr(end, last - end) +
         text.substr(begin, end - begin) + text.substr(last_end);
  const MeshFile read = read_text_of(text);
  EXPECT_EQ(read.file_rows.front(), 1);
  EXPECT_EQ(read.file_rows[n / 2 - 1], n - 1);
  EXPECT_EQ(read.file_rows[n / 2], 0);
  EXPECT_EQ(read.mesh.tetrahedra[n / 2 - 1], mesh.tetrahedra.front());
  EXPECT_EQ(read.mesh.tetrahedra[n / 2], mesh.tetrahedra.back());
}

TEST(MshReader, LengthsAreThoseOfGrainsOrOfTheFile) {
  Mesh mesh = two_slabs();
  const Vec3 shift(1, -2, 0.5);
  for (auto& x : mesh.nodes) x = 3 * x + shift;
  const std::string text = text_of(mesh);
  const MeshFile grains = read_text_of(text), file = read_text_of(text, LengthUnit::file);
  EXPECT_LT((grains.mesh.size - Vec3(2, 1, 1)).norm(), 1e-12);
  EXPECT_LT((file.mesh.size - Vec3(6, 3, 3)).norm(), 1e-12);
  for (int n = 0; n < mesh.node_count(); ++n) {
    EXPECT_LT((file.mesh.nodes[n] - (mesh.nodes[n] - shift)).norm(), 1e-12);
    EXPECT_LT((3 * grains.mesh.nodes[n] - file.mesh.nodes[n]).norm(), 1e-12);
  }
}

TEST(MshReader, ReadsCompressedFilesAndTellsDamagedOnes) {
  const Mesh mesh = two_slabs();
  const TemporaryFile file("packed.msh", text_of(mesh));
  ASSERT_EQ(std::system(("gzip -f " + file.path()).c_str()), 0);
  const std::string packed = file.path() + ".gz";
  EXPECT_EQ(read_msh(packed).mesh.nodes, mesh.nodes);
  const std::string bytes = core::read_text(packed);
  std::filesystem::remove(packed);
  EXPECT_EQ(fault(bytes.substr(0, bytes.size() / 2)),
            " the compressed file is damaged or ends early; copy it again");
}

TEST(MshReader, SaysWhereAFileIsWrong) {
  const std::string text = text_of(two_slabs());
  EXPECT_EQ(fault(""), "1: the file ends where $MeshFormat should be");
  EXPECT_NE(fault(text.substr(0, text.size() / 2)), "");
  EXPECT_NE(fault(text.substr(0, text.find("$EndElements"))).find(": the file ends where"),
            std::string::npos);
  EXPECT_NE(fault(text.substr(0, text.find("$Elements"))).find("there is no section $Elements"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "$EndNodes", "$EndKnots")).find("'$EndKnots' where $EndNodes"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "$Nodes", "$Knots")).find("another end inside"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "\n5 0 ", "\n5 nan ")).find("a coordinate of a node is nan"),
            std::string::npos);
  EXPECT_EQ(fault(replaced(text, "2.2 0 8", "4 0 8")),
            "2: version 4 of Gmsh's format; 2.2 and 4.1 are read (gmsh -save -format msh41)");
  EXPECT_EQ(fault(replaced(text, "2.2 0 8", "2.2 2 8")),
            "2: file type 2; 0 (ASCII) and 1 (binary) are read");
  EXPECT_EQ(fault(replaced(text, "2.2 0 8", "2.2 1 4")),
            "2: numbers of 4 bytes; binary files need 8");
  EXPECT_NE(fault(replaced(text, "2.2 0 8", "2.2 1 8")).find("the number 1 that tells"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "\n5 0 ", "\n4 0 ")).find("node 4 is there twice"),
            std::string::npos);
  EXPECT_NE(fault(replaced(text, "\n5 0 ", "\n5555 0 ")).find("node 5, which is not in $Nodes"),
            std::string::npos);
}

/// The text of a mesh of which a rule says the grain of each element; -1: the element is left out.
template <class GrainOf>
std::string regrouped(Mesh mesh, GrainOf&& grain_of) {
  Mesh fresh = mesh;
  fresh.tetrahedra.clear();
  fresh.tetrahedron_cell.clear();
  for (const auto& t : mesh.tetrahedra) {
    const Vec3 middle =
        (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]) / 4;
    const int grain = grain_of(middle);
    if (grain < 0) continue;
    fresh.tetrahedra.push_back(t);
    fresh.tetrahedron_cell.push_back(grain);
  }
  return text_of(fresh);
}

Mesh cubes() { return tests::box_mesh({3, 3, 3}, {3, 3, 3}); }
bool centre(const Vec3& x) { return (x - Vec3(1.5, 1.5, 1.5)).cwiseAbs().maxCoeff() < 0.5; }
bool axis(const Vec3& x) { return std::abs(x[0] - 1.5) < 0.5 && std::abs(x[1] - 1.5) < 0.5; }

TEST(MshReader, RefusesWhatHasNoTopologyOfGrains) {
  EXPECT_EQ(fault(regrouped(cubes(), [](const Vec3&) { return 0; })), "");
  const auto message = [](auto&& grain_of) { return fault(regrouped(cubes(), grain_of)); };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(message([](const Vec3& x) { return centre(x) ? -1 : 0; }),
         "grain 1 has a free facet at (0.333333, 0.333333, ");
  expect(message([](const Vec3& x) { return x[0] > 2 && x[1] > 2 ? -1 : 0; }),
         "its domain is neither a box");
  expect(message([](const Vec3& x) { return centre(x) ? 1 : 0; }),
         "grain 1 has a surface in 2 parts: it is in parts or has another grain inside");
  // Two cubes of a grain that meet in an edge only; in a corner only; nowhere.
  expect(message([](const Vec3& x) {
           return x[2] < 1 &&
                  ((x[0] < 1 && x[1] < 1) || (x[0] > 1 && x[0] < 2 && x[1] > 1 && x[1] < 2));
         }),
         "grain 1 is pinched");
  expect(message([](const Vec3& x) { return (x.array() < 1).all() || (x.array() > 2).all(); }),
         "grain 2 has a surface in 2 parts");
}

/// A grain in a pit of another: a face with a hole around it, and an edge without a vertex.
TEST(MshReader, PartsFacesWithHolesAndClosedEdges) {
  const MeshFile read =
      read_text_of(regrouped(cubes(), [](const Vec3& x) { return axis(x) && x[2] < 1 ? 1 : 0; }));
  ASSERT_NO_THROW(check(read.mesh));
  const auto found = sides(read.mesh.topology);
  EXPECT_EQ(std::count(found.begin(), found.end(), std::array<int, 3>{0, -1, 4}), 2);
  EXPECT_EQ(std::count(found.begin(), found.end(), std::array<int, 3>{1, -1, 4}), 1);
  EXPECT_EQ(std::count(found.begin(), found.end(), std::array<int, 3>{0, 1, -1}), 1);
  for (const auto& face : read.mesh.topology.faces) EXPECT_GE(face.edges.size(), 3U);
  // From side to side: the other grain has a tunnel.
  const MeshFile through =
      read_text_of(regrouped(cubes(), [](const Vec3& x) { return axis(x) ? 1 : 0; }));
  ASSERT_NO_THROW(check(through.mesh));
}

TEST(MshReader, ConvexDomainsComeBackWithTheNamesOfTheirSurfaces) {
  // A slanted prism: the box's x sides lean, and stay named x0 and x1.
  Mesh mesh = two_slabs();
  std::vector<Plane> planes;
  std::vector<std::string> names;
  for (const DomainFace& f : mesh.domain.faces) {
    Plane p = f.plane;
    if (std::abs(p.normal[0]) == 1) p.normal[2] = -0.25 * p.normal[0];
    planes.push_back(p);
    names.push_back(f.name);
  }
  for (Vec3& x : mesh.nodes) x[0] += 0.25 * x[2];
  mesh.domain = convex_domain("polyhedron", planes, names);
  mesh.size = mesh.domain.size;
  ASSERT_NO_THROW(check(mesh));
  const MeshFile read = read_text_of(text_of(mesh));
  ASSERT_NO_THROW(check(read.mesh));
  EXPECT_FALSE(read.mesh.domain.is_box());
  EXPECT_NEAR(read.mesh.domain.volume, 2, 1e-12);
  auto surfaces = read.mesh.domain.surface_names(), expected = mesh.domain.surface_names();
  std::sort(surfaces.begin(), surfaces.end());
  EXPECT_EQ(surfaces, expected);
  for (int n = 0; n < mesh.node_count(); ++n)
    EXPECT_LT((read.mesh.nodes[n] - mesh.nodes[n]).norm(), 1e-12);
  expect_same_counts(read.mesh.topology, mesh.topology);
  for (const auto& face : read.mesh.topology.faces) EXPECT_LT(face.domain_face, 6);
}

TEST(MshReader, RefusesElementsInsideOut) {
  Mesh mesh = two_slabs();
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  EXPECT_NE(fault(text_of(mesh)).find("element 8 of grain 1 has volume -"), std::string::npos);
}

}  // namespace
}  // namespace polyslip::mesh
