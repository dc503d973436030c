#include "results/picture_cut.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "mesh/measures.hpp"

namespace polyslip::results {
namespace {

using core::Vec3;

std::vector<char> hidden_grains(const mesh::Mesh& mesh) {
  std::vector<char> hidden;
  for (const auto& grain : mesh::measure(mesh).grains) {
    const Vec3 x = grain.centroid.cwiseQuotient(mesh.size);
    hidden.push_back(x[0] > 0.5 && x[1] < 0.5 && x[2] > 0.5);
  }
  return hidden;
}

}  // namespace

mesh::Mesh without_nearest_eighth(const mesh::Mesh& mesh) {
  const auto hidden = hidden_grains(mesh);
  mesh::Mesh rest = mesh;
  rest.tetrahedra.clear();
  rest.tetrahedron_cell.clear();
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    if (hidden[mesh.tetrahedron_cell[e]]) continue;
    rest.tetrahedra.push_back(mesh.tetrahedra[e]);
    rest.tetrahedron_cell.push_back(mesh.tetrahedron_cell[e]);
  }
  std::vector<char> turned(mesh.topology.faces.size(), false);
  for (std::size_t f = 0; f < turned.size(); ++f) {
    auto& face = rest.topology.faces[f];
    const bool first = hidden[face.cells[0]];
    const bool second = face.cells[1] >= 0 && hidden[face.cells[1]];
    if (first && (second || face.cells[1] < 0)) {
      face.cells[1] = face.cells[0];  // no outer face
    } else if (first || second) {
      if (first) std::swap(face.cells[0], face.cells[1]);
      turned[f] = first;
      face.cells[1] = -1;
    }
  }
  for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
    const auto& n = mesh.triangles[t];
    if (turned[rest.triangle_face[t]]) rest.triangles[t] = {n[0], n[2], n[1], n[5], n[4], n[3]};
  }
  return rest;
}

}  // namespace polyslip::results
