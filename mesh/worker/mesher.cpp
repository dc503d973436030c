#include "mesh/worker/mesher.hpp"

#include <vector>

namespace polyslip::mesh::worker {

namespace {

/// Another mesher without our optimiser.
class PlainMesher : public Mesher {
 public:
  explicit PlainMesher(std::unique_ptr<Mesher> mesher) : mesher_(std::move(mesher)) {}
  VolumeMesh fill(const SurfaceMesh& surface, double element_size) override {
    return mesher_->fill(surface, element_size);
  }
  bool is_optimised() const override { return false; }

 private:
  std::unique_ptr<Mesher> mesher_;
};

std::unique_ptr<Mesher> plain(std::unique_ptr<Mesher> mesher) {
  return std::make_unique<PlainMesher>(std::move(mesher));
}

}  // namespace

std::unique_ptr<Mesher> make_mesher(const std::string& name) {
  if (name == "gmsh-hxt") return make_gmsh_mesher(GmshAlgorithm::hxt);
  if (name == "gmsh-delaunay") return make_gmsh_mesher(GmshAlgorithm::delaunay);
  if (name == "netgen") return make_netgen_mesher(NetgenOptimiser::own, size_share);
  if (name == "gmsh-hxt-plain") return plain(make_gmsh_mesher(GmshAlgorithm::hxt));
  if (name == "gmsh-delaunay-plain") return plain(make_gmsh_mesher(GmshAlgorithm::delaunay));
  if (name == "paper-1") return plain(make_netgen_mesher(NetgenOptimiser::none, 1));
  if (name == "paper-2") return plain(make_netgen_mesher(NetgenOptimiser::own, 1));
  return nullptr;
}

std::unique_ptr<FaceMesher> make_face_mesher(const std::string& name) {
  if (name == "gmsh-frontal") return make_gmsh_face_mesher(GmshFaceAlgorithm::frontal);
  if (name == "gmsh-delaunay") return make_gmsh_face_mesher(GmshFaceAlgorithm::delaunay);
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
