// Polycrystals whose grains are merged from cells of a Voronoi tessellation, as measured ones look:
// pairs of grains with several faces, faces with holes, closed edges. They are moved by a grain's
// flow and remeshed like others: each mesh passes check(), volumes keep to the limits of
// remeshings.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/error.hpp"
#include "mesh/geometry.hpp"
#include "mesh/grain_topology.hpp"
#include "mesh/tessellation.hpp"
#include "remap/remesh.hpp"
#include "support/box_mesh.hpp"
#include "support/grain_flow.hpp"

namespace polyslip::remap {
namespace {

using core::Vec3;

mesh::MeshingOptions meshing() {
  mesh::MeshingOptions options;
  options.element_size = 0.7;
  return options;
}

mesh::Mesh polycrystal(int grains, std::uint64_t seed, mesh::MesherPool& pool) {
  auto tessellation = mesh::voronoi_tessellation({.grains = grains, .seed = seed});
  mesh::regularise(tessellation, {});
  mesh::MeshingReport report;
  return mesh::mesh_geometry(mesh::geometry_of(tessellation), meshing(), Vec3::Ones(), pool,
                             report);
}

/// The mesh with `grain_of` each cell instead, its topology found anew.
mesh::Mesh merged(const mesh::Mesh& mesh, const std::vector<int>& grain_of) {
  mesh::Mesh out;
  out.nodes = mesh.nodes;
  out.domain = mesh.domain;
  out.size = mesh.size;
  const int grains = 1 + *std::max_element(grain_of.begin(), grain_of.end());
  std::vector<int> names;
  for (int g = 0; g < grains; ++g) {
    names.push_back(g + 1);
    for (int e = 0; e < mesh.element_count(); ++e)
      if (grain_of[mesh.tetrahedron_cell[e]] == g) {
        out.tetrahedra.push_back(mesh.tetrahedra[e]);
        out.tetrahedron_cell.push_back(g);
      }
  }
  out.topology.cell_faces.resize(grains);
  mesh::find_grain_topology(out, names);
  mesh::check(out);
  return out;
}

std::set<std::pair<int, int>> neighbours(const mesh::Topology& t) {
  std::set<std::pair<int, int>> pairs;
  for (const auto& f : t.faces)
    if (f.cells[1] >= 0) pairs.insert(std::minmax(f.cells[0], f.cells[1]));
  return pairs;
}

/// Faces beyond the first between two grains, or of a grain on a face of the domain.
int further_faces(const mesh::Topology& t) {
  std::map<std::array<int, 3>, int> faces;
  for (const auto& f : t.faces) {
    const auto [a, b] = std::minmax(f.cells[0], f.cells[1]);
    ++faces[{a, b, f.domain_face}];
  }
  return static_cast<int>(t.faces.size() - faces.size());
}

/// Whether the second grain's face on z0 is a ring, of at least two parts.
bool has_ring(const mesh::Topology& t) {
  int parts = 0;
  for (const auto& f : t.faces) parts += f.cells[0] == 1 && f.domain_face == 4;
  return parts >= 2;
}

struct Count {
  std::size_t faces = 0, copied = 0;  ///< of all remeshings
};

void remesh_while_it_flows(mesh::Mesh mesh, mesh::MesherPool& pool, Count& count) {
  const test::GrainFlow flow(mesh.size, {.strength = 0.2, .seed = 3});
  constexpr double interval = 0.25, end = 0.5;
  for (double strain = 0; strain < end - 1e-9; strain += interval) {
    flow.move(mesh, strain, strain + interval);
    const auto before = mesh::grain_volumes(mesh);
    mesh::DeformedRegularisation regularisation;
    mesh::MeshingReport report;
    const auto faces = mesh.topology.faces.size();
    mesh = mesh::mesh_geometry(regularised_geometry(mesh, {}, regularisation), meshing(),
                               meshing_scale(mesh, {}), pool, report);
    ASSERT_NO_THROW(mesh::check(mesh));
    EXPECT_EQ(mesh.topology.faces.size(), faces);
    count.faces += faces;
    count.copied += report.copied_faces.size();
    const auto after = mesh::grain_volumes(mesh);
    for (std::size_t g = 0; g < before.size(); ++g) EXPECT_NEAR(after[g] / before[g], 1, 3e-3) << g;
    EXPECT_GT(test::scaled_quality(mesh, mesh::isotropic_scale(mesh)).min_radius_ratio, 0.05);
  }
}

/// A cell at the middle of z0, all cells around it, and the others: a ring on z0, closed edges.
TEST(MergedGrains, AGrainInThePitOfAnother) {
  const auto pool = mesh::MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  const mesh::Mesh fine = polycrystal(60, 2, *pool);
  std::set<int> outer;
  for (const auto& face : fine.topology.faces)
    if (face.domain_face == 4) outer.insert(face.cells[0]);
  mesh::Mesh mesh;
  for (const int core : outer) {
    std::vector<int> grain(60, 0);
    for (const auto& [a, b] : neighbours(fine.topology))
      if (a == core || b == core) grain[a] = grain[b] = 1;
    grain[core] = 2;
    try {
      mesh = merged(fine, grain);
    } catch (const core::InputError&) {
      continue;  // neighbours may meet in an edge only
    }
    if (has_ring(mesh.topology)) break;
  }
  ASSERT_TRUE(has_ring(mesh.topology));
  EXPECT_GE(further_faces(mesh.topology), 1);
  Count count;
  remesh_while_it_flows(mesh, *pool, count);
  EXPECT_EQ(count.copied, 0U);
}

/// Grains grown at random from cell to cell: those that do not touch themselves.
TEST(MergedGrains, GrownAtRandom) {
  const auto pool = mesh::MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  constexpr int cells = 40, grains = 6;
  const mesh::Mesh fine = polycrystal(cells, 1, *pool);
  const auto pairs = neighbours(fine.topology);
  int remeshed = 0, refused = 0, further = 0;
  Count count;
  for (unsigned seed = 1; seed <= 12 && remeshed < 3; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::pair<int, int>> order(pairs.begin(), pairs.end());
    std::shuffle(order.begin(), order.end(), random);
    std::vector<int> grain(cells, -1);
    for (int g = 0; g < grains; ++g) grain[(7 * g + static_cast<int>(seed)) % cells] = g;
    while (std::count(grain.begin(), grain.end(), -1) > 0)
      for (const auto& [a, b] : order)
        if ((grain[a] < 0) != (grain[b] < 0)) {
          grain[a] = grain[b] = std::max(grain[a], grain[b]);
          break;
        }
    mesh::Mesh mesh;
    try {
      mesh = merged(fine, grain);
    } catch (const core::InputError&) {
      ++refused;
      continue;
    }
    const int more = further_faces(mesh.topology);
    if (more == 0) continue;
    further += more;
    ++remeshed;
    SCOPED_TRACE(seed);
    remesh_while_it_flows(mesh, *pool, count);
  }
  EXPECT_EQ(remeshed, 3) << refused << " refused";
  EXPECT_GE(further, 3);
  EXPECT_LE(count.copied, count.faces / 100) << count.faces;
}

/// Two grains: a corner of a box, above `height`, its upright edge moved outwards by `lean`; and
/// the rest. Their face meets the sides of the box along two edges each, at an angle.
mesh::Mesh corner_of_a_box(double lean, double height) {
  mesh::Mesh box = tests::box_mesh({2, 2, 2}, {1, 1, 1});
  std::vector<int> grain_of(box.element_count(), 0);
  for (int e = 0; e < box.element_count(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < 4; ++i) centre += box.nodes[box.tetrahedra[e][i]] / 4;
    grain_of[e] = (centre.array() > 0.5).all();
    box.tetrahedron_cell[e] = e;
  }
  mesh::Mesh mesh = merged(box, grain_of);
  for (Vec3& x : mesh.nodes) {
    x[2] = x[2] < 0.5 ? 2 * height * x[2] : height + (1 - height) * (2 * x[2] - 1);
    const double move = lean * (1 - 2 * std::abs(x[0] - 0.5)) * (1 - 2 * std::abs(x[1] - 0.5));
    x[0] -= move;
    x[1] -= move;
  }
  return mesh;
}

/// A triangle across such an angle would lie in the side of the box, and no tetrahedron fits
/// between.
TEST(MergedGrains, AFaceMeetsSidesOfTheBoxAtAnAngle) {
  const auto pool = mesh::MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  struct Case {
    double lean, height, element_size;
  };
  for (const auto& [lean, height, element_size] :
       {Case{0.1, 0.5, 1}, Case{0.2, 0.2, 0.7}, Case{0.4, 0.8, 0.7}}) {
    mesh::MeshingOptions options;
    options.element_size = element_size;
    mesh::MeshingReport report;
    const mesh::Mesh fresh = mesh::mesh_geometry(mesh::geometry_of(corner_of_a_box(lean, height)),
                                                 options, Vec3::Ones(), *pool, report);
    ASSERT_NO_THROW(mesh::check(fresh));
    EXPECT_EQ(report.copied_faces.size(), 0U) << lean;
    EXPECT_EQ(report.faults.size(), 0U) << lean;
  }
}

}  // namespace
}  // namespace polyslip::remap
