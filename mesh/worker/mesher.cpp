#include "mesh/worker/mesher.hpp"

#include <vector>

namespace polyslip::mesh::worker {

std::unique_ptr<Mesher> make_mesher(const std::string& name) {
  if (name == "gmsh-hxt") return make_gmsh_mesher(GmshAlgorithm::hxt);
  if (name == "gmsh-delaunay") return make_gmsh_mesher(GmshAlgorithm::delaunay);
  if (name == "netgen") return make_netgen_mesher();
  return nullptr;
}

VolumeMesh without_unused_nodes(const VolumeMesh& mesh, std::size_t kept) {
  std::vector<int> number(mesh.nodes.size(), -1);
  for (const auto& t : mesh.tetrahedra)
    for (const int n : t) number.at(n) = 0;
  VolumeMesh result;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (i >= kept && number[i] < 0) continue;
    number[i] = static_cast<int>(result.nodes.size());
    result.nodes.push_back(mesh.nodes[i]);
  }
  for (auto t : mesh.tetrahedra) {
    for (int& n : t) n = number[n];
    result.tetrahedra.push_back(t);
  }
  return result;
}

}  // namespace polyslip::mesh::worker
