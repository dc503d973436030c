// partition_elements: PT-Scotch on the graph of elements that share a face.

#include <cstdio>  // scotch.h needs it

#include <scotch.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <tuple>

#include "core/error.hpp"
#include "solver/partition.hpp"
#include "solver/petsc_handle.hpp"

namespace polyslip::solver {
namespace {

/// Below so many elements a rank parts of a graph are ragged, and may be empty.
constexpr int few_elements = 200;

/// Pairs of elements that share a face, ascending by the first.
std::vector<std::array<int, 2>> face_neighbours(const mesh::Mesh& mesh) {
  constexpr int face_corners[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  struct Face {
    std::array<int, 3> corners;
    int element;
  };
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (int e = 0; e < mesh.element_count(); ++e)
    for (const auto& f : face_corners) {
      const auto& t = mesh.tetrahedra[e];
      std::array<int, 3> corners{t[f[0]], t[f[1]], t[f[2]]};
      std::sort(corners.begin(), corners.end());
      faces.push_back({corners, e});
    }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.corners, a.element) < std::tie(b.corners, b.element);
  });
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].corners != faces[i - 1].corners) continue;
    pairs.push_back({faces[i].element, faces[i - 1].element});
    pairs.push_back({faces[i - 1].element, faces[i].element});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Each element's neighbours across faces, in rows of PETSc's matrix of neighbours.
MatHandle face_graph(const mesh::Mesh& mesh) {
  const auto pairs = face_neighbours(mesh);
  const std::size_t n = mesh.tetrahedra.size();
  // PETSc frees them with the matrix.
  PetscInt *start = nullptr, *neighbours = nullptr;
  check(PetscCalloc1(n + 1, &start));
  check(PetscMalloc1(pairs.size(), &neighbours));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ++start[pairs[i][0] + 1];
    neighbours[i] = pairs[i][1];
  }
  for (std::size_t e = 0; e < n; ++e) start[e + 1] += start[e];
  MatHandle graph;
  const auto size = static_cast<PetscInt>(n);
  check(MatCreateMPIAdj(PETSC_COMM_SELF, size, size, start, neighbours, nullptr, graph.out()));
  return graph;
}

}  // namespace

std::vector<int> partition_elements(const mesh::Mesh& mesh, int ranks) {
  const int n = mesh.element_count();
  if (ranks == 1) return std::vector<int>(static_cast<std::size_t>(n), 0);
  if (n < few_elements * ranks) return bisect_elements(mesh, ranks);
  const MatHandle graph = face_graph(mesh);
  PartitioningHandle partitioning;
  check(MatPartitioningCreate(PETSC_COMM_SELF, partitioning.out()));
  check(MatPartitioningSetAdjacency(partitioning.get(), graph.get()));
  check(MatPartitioningSetType(partitioning.get(), MATPARTITIONINGPTSCOTCH));
  check(MatPartitioningSetNParts(partitioning.get(), ranks));
  // The same parts in every process and whatever was cut before: Scotch's threads race otherwise.
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 1);
  SCOTCH_randomReset();
  IsHandle parts;
  check(MatPartitioningApply(partitioning.get(), parts.out()));
  const PetscInt* ranks_of = nullptr;
  check(ISGetIndices(parts.get(), &ranks_of));
  std::vector<int> rank(ranks_of, ranks_of + n);
  check(ISRestoreIndices(parts.get(), &ranks_of));
  return rank;
}

}  // namespace polyslip::solver
