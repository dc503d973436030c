#pragma once
// The topology of a polycrystal of which only the tetrahedra and their grains are known.

#include "mesh/mesh.hpp"

namespace polyslip::mesh {

/// Fills in triangles, lines, vertex nodes and the topology of a mesh that has its order, nodes,
/// tetrahedra (sorted by grain; every grain has some), tetrahedron_cell and topology.cell_faces of
/// the right length, its domain and size, and of a periodic mesh periodic_nodes: free facets whose
/// nodes are translates of another's are of periodic faces; nodes within 1e-6 of the smallest side
/// of a domain face that their facet lies on are put on it. A face is a connected set of facets
/// between the same two grains, or one grain and the same face of the domain; one that is no disc
/// (closed, with holes, touching itself), or that no map lays flat, is parted into several that
/// are. Faces meet in edges, edges end in vertices, on closed ones some are put. Faces are numbered
/// by their grains, edges and vertices by their first nodes. Throws InputError, naming the grain by
/// `grain_names`, for what has no such topology: facets on the surface but on no face of the domain
/// (a hole, a domain that is not convex), overlapping elements, periodic faces that need
/// parting, grains in parts, around others, or that touch themselves.
void find_grain_topology(Mesh& mesh, const std::vector<int>& grain_names);

}  // namespace polyslip::mesh
