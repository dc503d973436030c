#pragma once
// Which rank works on which elements, and who owns which node.

#include <mpi.h>
#include <petscsys.h>

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace polyslip::solver {

/// Rank of each element: recursive bisection of the elements' centroids across the longest side of
/// their box, ties by element number. A function of mesh and number of ranks alone.
std::vector<int> partition_elements(const mesh::Mesh& mesh, int ranks);

/// What one rank knows of the mesh. Local nodes: first those it owns, by mesh number, then its
/// ghosts, by global number (hence by owner). A node belongs to the smallest rank that touches it;
/// global numbers are contiguous on a rank.
struct LocalMesh {
  MPI_Comm comm = MPI_COMM_SELF;
  int owned_nodes = 0, local_nodes = 0;
  PetscInt first_node = 0, global_nodes = 0;        ///< global number of owned node 0; total
  PetscInt first_element = 0, global_elements = 0;  ///< likewise
  std::vector<PetscInt> node_global;                ///< [local_nodes]
  std::vector<int> node_mesh;                       ///< [local_nodes] index in Mesh::nodes
  std::vector<std::uint8_t> node_faces;             ///< [local_nodes] bit f: on domain face f
  std::vector<std::array<int, 10>> elements;        ///< local nodes, by mesh number
  std::vector<int> element_mesh;                    ///< index in Mesh::tetrahedra
  std::vector<std::array<PetscInt, 2>> parents;     ///< [owned_nodes] see LinearLayout
  std::vector<std::uint8_t> is_corner;              ///< [owned_nodes]

  int element_count() const { return static_cast<int>(elements.size()); }
  bool owned(int node) const { return node < owned_nodes; }
};

/// A mesh spread over the ranks, and the way there and back for its fields.
class Distribution {
 public:
  /// Mesh and element_rank are read on rank 0. Collective.
  Distribution(MPI_Comm comm, const mesh::Mesh& mesh, const std::vector<int>& element_rank);

  const LocalMesh& local() const { return local_; }

  /// [mesh nodes][components] on rank 0 -> [local_nodes][components], ghosts filled. Collective.
  std::vector<double> scatter_nodes(const std::vector<double>& values, int components) const;
  /// [mesh elements][components] on rank 0 -> [elements][components]. Collective.
  std::vector<double> scatter_elements(const std::vector<double>& values, int components) const;
  /// [local_nodes][components] (owned ones are read) -> [mesh nodes][components] on rank 0.
  std::vector<double> gather_nodes(const std::vector<double>& values, int components) const;
  std::vector<double> gather_elements(const std::vector<double>& values, int components) const;

 private:
  LocalMesh local_;
  // On rank 0: for each rank its local nodes and its elements, as mesh numbers.
  std::vector<std::vector<int>> nodes_of_, elements_of_;
  std::vector<int> owned_of_;
};

/// Values of nodes between their owner and the ranks that see them as ghosts.
class NodeExchange {
 public:
  /// Collective.
  explicit NodeExchange(const LocalMesh& local);

  /// Ghosts take the value of their owner. values: [local_nodes][components]. Collective.
  void update_ghosts(std::vector<double>& values, int components) const;
  /// Owners add the values of their ghosts, rank by rank; ghosts keep theirs. Collective.
  void add_ghosts(std::vector<double>& values, int components) const;

  const std::vector<int>& neighbours() const { return neighbours_; }
  /// For each neighbour: owned nodes that it sees, ghosts that it owns; in the same order there.
  const std::vector<std::vector<int>>& seen_by() const { return seen_by_; }
  const std::vector<std::vector<int>>& ghosts_of() const { return ghosts_of_; }

 private:
  MPI_Comm comm_;
  std::vector<int> neighbours_;
  std::vector<std::vector<int>> seen_by_, ghosts_of_;
};

}  // namespace polyslip::solver
