#include "mesh/tetrahedral_optimiser.hpp"

#include <algorithm>
#include <vector>

#include "mesh/edge_removal.hpp"
#include "mesh/mesh.hpp"
#include "mesh/node_insertion.hpp"
#include "mesh/node_relocation.hpp"
#include "mesh/tet_store.hpp"

namespace polyslip::mesh {
namespace {

constexpr int rounds = 4;
constexpr int flip_passes = 4;
constexpr int relocation_sweeps = 2;
constexpr double flipped_below = 0.7;       // elements whose edges and facets are tried
constexpr double node_changed_below = 0.3;  // elements for which nodes come and go
constexpr double flip_gain = 1e-3;
constexpr double node_gain = 0.03;
// Where only the worst elements are looked at:
constexpr int worst_relocations = 5;
constexpr double worst_node_gain = 0.003;

/// Elements of radius ratio below `limit`, the worst first.
std::vector<int> worst_first(const TetStore& store, double limit) {
  std::vector<int> order;
  for (int t = 0; t < store.slot_count(); ++t)
    if (store.alive(t) && store.quality(t) < limit) order.push_back(t);
  std::stable_sort(order.begin(), order.end(),
                   [&](int s, int t) { return store.quality(s) < store.quality(t); });
  return order;
}

/// The first edge or facet of element t whose change helps.
bool flip(TetStore& store, int t) {
  const TetStore::Tet tet = store.tet(t);
  for (const auto& edge : tetrahedron_edges)
    if (remove_edge(store, tet[edge[0]], tet[edge[1]], flip_gain)) return true;
  for (int i = 0; i < 4; ++i)
    if (flip_facet(store, t, i, flip_gain)) return true;
  return false;
}

bool collapse_a_node(TetStore& store, int t, double gain) {
  const TetStore::Tet tet = store.tet(t);
  return std::any_of(tet.begin(), tet.end(),
                     [&](int node) { return collapse_node(store, node, gain); });
}

bool split_an_edge(TetStore& store, int t, double gain) {
  const TetStore::Tet tet = store.tet(t);
  return std::any_of(tetrahedron_edges.begin(), tetrahedron_edges.end(), [&](const auto& edge) {
    return split_edge(store, tet[edge[0]], tet[edge[1]], gain);
  });
}

bool change_nodes(TetStore& store, int t) {
  return collapse_a_node(store, t, node_gain) || split_an_edge(store, t, node_gain);
}

bool change_nodes_at_worst(TetStore& store, int t, int power) {
  return collapse_a_node(store, t, worst_node_gain) ||
         insert_node(store, t, worst_node_gain, power);
}

/// Whether `change` changed any of the elements below `limit`.
template <class Change>
bool change_worst(TetStore& store, double limit, const Change& change) {
  bool any = false;
  for (const int t : worst_first(store, limit))
    if (store.alive(t)) any |= change(store, t);
  return any;
}

bool relocate_all(TetStore& store) {
  bool any = false;
  for (int node = 0; node < store.node_count(); ++node)
    if (store.is_free(node)) any |= relocate(store, node);
  return any;
}

/// Nodes of the elements below `limit`, several times as long as some moves.
bool relocate_worst(TetStore& store, double limit, int power) {
  std::vector<int> nodes;
  for (const int t : worst_first(store, limit))
    for (const int node : store.tet(t))
      if (store.is_free(node) && std::find(nodes.begin(), nodes.end(), node) == nodes.end())
        nodes.push_back(node);
  bool any = false;
  for (int i = 0; i < worst_relocations; ++i)
    for (const int node : nodes) any |= relocate(store, node, power);
  return any;
}

}  // namespace

VolumeMesh optimise_inside(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  TetStore store(mesh, surface.nodes.size());
  for (int round = 0; round < rounds; ++round) {
    bool any = false;
    for (int i = 0; i < flip_passes && change_worst(store, flipped_below, flip); ++i) any = true;
    for (int i = 0; i < relocation_sweeps && relocate_all(store); ++i) any = true;
    any |= change_worst(store, node_changed_below, change_nodes);
    if (!any) break;
  }
  VolumeMesh result = store.mesh();
  return validate(surface, result).empty() ? result : mesh;
}

VolumeMesh raise_worst_inside(const SurfaceMesh& surface, const VolumeMesh& mesh, double limit,
                              int power) {
  if (min_radius_ratio(mesh) >= limit) return mesh;
  TetStore store(mesh, surface.nodes.size());
  for (int round = 0; round < rounds; ++round) {
    bool any = change_worst(store, limit, flip);
    any |= relocate_worst(store, limit, power);
    any |= change_worst(store, limit,
                        [power](TetStore& s, int t) { return change_nodes_at_worst(s, t, power); });
    if (!any) break;
  }
  VolumeMesh result = store.mesh();
  return validate(surface, result).empty() ? result : mesh;
}

}  // namespace polyslip::mesh
