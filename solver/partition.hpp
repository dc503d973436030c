#pragma once
// Which rank works on which elements, and who owns which node.

#include <mpi.h>
#include <petscsys.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/profile.hpp"

namespace polyslip::solver {

/// Rank of each element, on this rank alone: PT-Scotch, through PETSc, on the graph of elements
/// that share a face, which keeps small what neighbours exchange. A function of mesh and number of
/// ranks alone. Every rank has an element if there are enough.
std::vector<int> partition_elements(const mesh::Mesh& mesh, int ranks);
/// The same by recursive bisection of the elements' centroids across the longest side of their box,
/// ties by element number: balanced to one element. For meshes of few elements a rank.
std::vector<int> bisect_elements(const mesh::Mesh& mesh, int ranks);

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

/// Appends the values at this rank's owned nodes or elements first ... last - 1 (local numbers).
using AppendRows = std::function<void(std::size_t first, std::size_t last, std::vector<double>&)>;
/// Rows of an array [nodes or elements][each], which has to outlive them.
AppendRows rows_of(const std::vector<double>& values, std::size_t each);

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
  /// Values of the mesh's nodes or elements first ... last - 1, `each` of one, on rank 0; empty
  /// elsewhere. Collective.
  std::vector<double> gather_node_rows(const AppendRows& append, std::size_t first,
                                       std::size_t last, std::size_t each) const;
  std::vector<double> gather_element_rows(const AppendRows& append, std::size_t first,
                                          std::size_t last, std::size_t each) const;

 private:
  LocalMesh local_;
  // On rank 0: for each rank its local nodes and its elements, as mesh numbers.
  std::vector<std::vector<int>> nodes_of_, elements_of_;
  std::vector<int> owned_of_;

  std::vector<double> gather_rows(const AppendRows& append, std::span<const int> mine, bool nodes,
                                  std::size_t first, std::size_t last, std::size_t each) const;
};

/// Values of nodes between their owner and the ranks that see them as ghosts. One message each way
/// between two ranks that share nodes.
class NodeExchange {
 public:
  /// Collective. Time and traffic are booked in `profile`, if there is one.
  explicit NodeExchange(const LocalMesh& local, Profile* profile = nullptr);
  /// The same for some of the nodes: number[node] is the new number, or negative.
  NodeExchange(const NodeExchange& all, const std::vector<int>& number);

  /// Ghosts take the value of their owner. values: [local_nodes][components]. Collective.
  template <class T>
  void update_ghosts(T* values, int components) const {
    move(values, sizeof(T) * static_cast<std::size_t>(components));
  }
  template <class T>
  void update_ghosts(std::vector<T>& values, int components) const {
    update_ghosts(values.data(), components);
  }
  /// Owners add the values of their ghosts, rank by rank; ghosts keep theirs. Collective.
  template <class T>
  void add_ghosts(T* values, int components) const;
  template <class T>
  void add_ghosts(std::vector<T>& values, int components) const {
    add_ghosts(values.data(), components);
  }

  const std::vector<int>& neighbours() const { return neighbours_; }
  /// For each neighbour: owned nodes that it sees, ghosts that it owns; in the same order there.
  const std::vector<std::vector<int>>& seen_by() const { return seen_by_; }
  const std::vector<std::vector<int>>& ghosts_of() const { return ghosts_of_; }
  MPI_Comm comm() const { return comm_; }
  Profile* profile() const { return profile_; }

 private:
  using Lists = std::vector<std::vector<int>>;
  MPI_Comm comm_;
  Profile* profile_ = nullptr;
  std::vector<int> neighbours_;
  Lists seen_by_, ghosts_of_;

  /// Sends the entities of `out`, of `size` bytes each, to the neighbours, and returns what they
  /// sent for those of `in`, one after the other.
  std::vector<char> pass(const char* values, std::size_t size, const Lists& out,
                         const Lists& in) const;
  void move(void* values, std::size_t size) const;
};

template <class T>
void NodeExchange::add_ghosts(T* values, int components) const {
  if (neighbours_.empty()) return;
  const auto n = static_cast<std::size_t>(components);
  const std::vector<char> bytes =
      pass(reinterpret_cast<const char*>(values), n * sizeof(T), ghosts_of_, seen_by_);
  const T* received = reinterpret_cast<const T*>(bytes.data());
  for (const auto& nodes : seen_by_)
    for (int node : nodes)
      for (std::size_t c = 0; c < n; ++c)
        values[static_cast<std::size_t>(node) * n + c] += *received++;
}

}  // namespace polyslip::solver
