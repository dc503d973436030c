#include "solver/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/error.hpp"
#include "solver/exchange.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::solver {
namespace {

mesh::Mesh box() { return tests::box_mesh({4, 3, 2}, {2, 1.5, 1}, 2); }

/// Faces between elements of different parts.
int cut_faces(const mesh::Mesh& m, const std::vector<int>& parts) {
  std::map<std::set<int>, int> seen;
  int cut = 0;
  for (int e = 0; e < m.element_count(); ++e)
    for (int out = 0; out < 4; ++out) {
      std::set<int> face;
      for (int a = 0; a < 4; ++a)
        if (a != out) face.insert(m.tetrahedra[e][a]);
      const auto [at, first] = seen.try_emplace(face, e);
      if (!first && parts[at->second] != parts[e]) ++cut;
    }
  return cut;
}

TEST(Partition, GraphIsCutInBalancedPartsWithFewFacesBetween) {
  const mesh::Mesh m = tests::box_mesh({8, 8, 7}, {2, 1.5, 1}, 2);
  for (int ranks : {1, 2, 3, 5}) {
    const auto parts = partition_elements(m, ranks);
    ASSERT_EQ(parts, partition_elements(m, ranks));
    ASSERT_EQ(static_cast<int>(parts.size()), m.element_count());
    for (int r = 0; r < ranks; ++r) {
      const double n = static_cast<double>(std::count(parts.begin(), parts.end(), r));
      EXPECT_NEAR(n * ranks / m.element_count(), 1, 0.05) << r << " of " << ranks;
    }
    EXPECT_LE(cut_faces(m, parts), 1.1 * cut_faces(m, bisect_elements(m, ranks))) << ranks;
  }
}

TEST(Partition, BisectedPartsAreBalancedAndAFunctionOfTheMesh) {
  const mesh::Mesh m = box();
  for (int ranks : {1, 2, 3, 5}) {
    const auto parts = bisect_elements(m, ranks);
    ASSERT_EQ(parts, bisect_elements(m, ranks));
    ASSERT_EQ(parts, partition_elements(m, ranks)) << "few elements a rank";
    ASSERT_EQ(static_cast<int>(parts.size()), m.element_count());
    for (int r = 0; r < ranks; ++r) {
      const auto n = std::count(parts.begin(), parts.end(), r);
      EXPECT_NEAR(static_cast<double>(n), 144.0 / ranks, 2.0) << r << " of " << ranks;
    }
  }
}

TEST(Partition, EveryElementAndNodeHasOneOwnerAndFieldsGoRound) {
  const mesh::Mesh m = box();
  const int ranks = size_of(MPI_COMM_WORLD);
  const Distribution d(MPI_COMM_WORLD, m, partition_elements(m, ranks));
  const LocalMesh& local = d.local();
  EXPECT_EQ(local.global_nodes, m.node_count());
  EXPECT_EQ(local.global_elements, m.element_count());
  EXPECT_EQ(sum(MPI_COMM_WORLD, local.owned_nodes), m.node_count());
  EXPECT_EQ(sum(MPI_COMM_WORLD, local.element_count()), m.element_count());

  std::vector<double> nodes(2 * m.nodes.size()), elements(3 * m.tetrahedra.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = 0.5 + static_cast<double>(i);
  for (std::size_t i = 0; i < elements.size(); ++i) elements[i] = -1.0 - static_cast<double>(i);
  const auto local_nodes = d.scatter_nodes(nodes, 2);
  const auto local_elements = d.scatter_elements(elements, 3);
  for (int i = 0; i < local.local_nodes; ++i)
    EXPECT_EQ(local_nodes[2 * i + 1], nodes[2 * local.node_mesh[i] + 1]);
  const auto back_nodes = d.gather_nodes(local_nodes, 2);
  const auto back_elements = d.gather_elements(local_elements, 3);
  if (rank_of(MPI_COMM_WORLD) == 0) {
    EXPECT_EQ(back_nodes, nodes);
    EXPECT_EQ(back_elements, elements);
  }
  for (int e = 0; e < local.element_count(); ++e)
    for (int a = 0; a < 10; ++a)
      EXPECT_EQ(local.node_mesh[local.elements[e][a]], m.tetrahedra[local.element_mesh[e]][a]);
}

TEST(Partition, GhostsFollowTheirOwnersAndAddToThem) {
  const mesh::Mesh m = box();
  const Distribution d(MPI_COMM_WORLD, m, partition_elements(m, size_of(MPI_COMM_WORLD)));
  const LocalMesh& local = d.local();
  const NodeExchange exchange(local);
  std::vector<double> values(local.local_nodes, -1);
  for (int i = 0; i < local.owned_nodes; ++i) values[i] = local.node_mesh[i];
  exchange.update_ghosts(values, 1);
  for (int i = 0; i < local.local_nodes; ++i) EXPECT_EQ(values[i], local.node_mesh[i]);

  // Elements at each node, counted over the ranks, against the mesh.
  std::vector<double> counts(local.local_nodes, 0), expected(m.nodes.size(), 0);
  for (const auto& e : local.elements)
    for (int node : e) counts[node] += 1;
  exchange.add_ghosts(counts, 1);
  for (const auto& e : m.tetrahedra)
    for (int node : e) expected[node] += 1;
  for (int i = 0; i < local.owned_nodes; ++i) EXPECT_EQ(counts[i], expected[local.node_mesh[i]]);
}

TEST(Partition, ParentsAreTheEndsOfEdgesAndFacesAreTheDomains) {
  const mesh::Mesh m = box();
  const Distribution d(MPI_COMM_WORLD, m, partition_elements(m, size_of(MPI_COMM_WORLD)));
  const LocalMesh& local = d.local();
  int corners = 0;
  for (int i = 0; i < local.owned_nodes; ++i) {
    corners += local.is_corner[i];
    EXPECT_EQ(local.is_corner[i] != 0, local.parents[i][0] == local.parents[i][1]);
    if (local.is_corner[i]) {
      EXPECT_EQ(local.parents[i][0], local.first_node + i);
    }
    const core::Vec3& x = m.nodes[local.node_mesh[i]];
    EXPECT_EQ((local.node_faces[i] & 1u) != 0, x[0] == 0);
    EXPECT_EQ((local.node_faces[i] & 32u) != 0, x[2] == 1);
  }
  EXPECT_EQ(sum(MPI_COMM_WORLD, corners), 5 * 4 * 3);
}

TEST(Exchange, AnErrorOnRootReachesEveryRankWithItsKindAndText) {
  EXPECT_THROW(on_root(MPI_COMM_WORLD, [] { throw core::InputError("wrong"); }), core::InputError);
  EXPECT_THROW(on_root(MPI_COMM_WORLD, [] { throw core::RecoverableError("again"); }),
               core::RecoverableError);
  try {
    on_root(MPI_COMM_WORLD, [] { throw core::InternalError("at the root"); });
    FAIL();
  } catch (const core::InternalError& e) {
    EXPECT_STREQ(e.what(), "at the root");
  }
  EXPECT_NO_THROW(on_root(MPI_COMM_WORLD, [] {}));
}

}  // namespace
}  // namespace polyslip::solver
