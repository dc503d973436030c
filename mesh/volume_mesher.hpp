#pragma once
// Meshing one grain's inside from its surface, by several meshers in worker processes; and faces.

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/face_mesher.hpp"

namespace polyslip::mesh {

/// Names that a deck may list: Gmsh's HXT and Delaunay, Netgen; each with its optimiser, Gmsh's and
/// ours (mesh/tetrahedral_optimiser.hpp). Gmsh's two without ours. The paper's two (section 2.2.2),
/// without ours and at c_l as they stand there: Netgen without its optimiser and with it, then
/// Gmsh's optimiser.
inline const std::array<std::string, 7> known_meshers{
    "gmsh-hxt", "gmsh-delaunay", "netgen", "gmsh-hxt-plain", "gmsh-delaunay-plain",
    "paper-1",  "paper-2"};

/// Closed surface, outward normals, no unused nodes.
struct SurfaceMesh {
  std::vector<core::Vec3> nodes;
  std::vector<std::array<int, 3>> triangles;
};

/// The first nodes are the surface's, bit for bit; tetrahedra positive.
struct VolumeMesh {
  std::vector<core::Vec3> nodes;
  std::vector<std::array<int, 4>> tetrahedra;
};

struct GrainRequest {
  int grain = 0;
  SurfaceMesh surface;
  double element_size = 0;  ///< c_l of this grain; 0: that of the pool's options
};

struct GrainResult {
  int grain = 0;
  bool ok = false;     ///< some mesher gave a valid mesh
  VolumeMesh mesh;     ///< the best: see MesherPool::mesh
  std::string mesher;  ///< the winner
  double O = 0;
  /// one line for each failed candidate: mesher, grain (from 1), why
  std::vector<std::string> faults;
};

/// Makes the request at a place among all; each is asked for once, in their order.
using RequestSource = std::function<GrainRequest(std::size_t place)>;
/// Takes the result of the request at a place.
using ResultSink = std::function<void(std::size_t place, GrainResult&& result)>;

struct PoolOptions {
  std::vector<std::string> meshers{"gmsh-hxt", "gmsh-delaunay", "netgen"};
  double element_size = 0.5;  ///< c_l
  /// Share of the O that a grain's surface allows from which on no further mesher tries the grain
  /// (mesh/candidate.hpp); 1: every mesher tries every grain.
  double target = 0.9;
  double timeout = 60;   ///< CPU seconds a grain and candidate (RLIMIT_CPU of the child)
  int jobs = 0;          ///< 0: one a core
  bool optimise = true;  ///< by our optimiser, after the meshers that it belongs to
};

/// Worker processes that hold Gmsh and Netgen; the main program never links them. `start` must be
/// called first thing in main, before MPI_Init and before memory grows: it forks a small spawner.
class MesherPool {
 public:
  static std::unique_ptr<MesherPool> start(const std::string& worker_executable);
  ~MesherPool();
  MesherPool(const MesherPool&) = delete;
  MesherPool& operator=(const MesherPool&) = delete;

  /// The first mesher meshes every grain, each other those of which no mesh so far is good enough
  /// (`target`), and the best mesh of a grain wins: first by its worst radius
  /// ratio as far as it is below 0.2 (in steps of 0.02), then by O (eq. 5), then by the order of
  /// the meshers. O alone would take larger elements for a sliver.
  ///
  /// Results in the order of the requests; the same for any number of jobs: the requests are cut
  /// into batches of a fixed size, each (batch, mesher) runs in a process of its own, and what is
  /// left of a batch after a fault goes on in a new one. A grain that no mesher could mesh has `ok`
  /// false. Throws InputError for an unknown mesher or if the worker program cannot be started,
  /// RecoverableError if the machine has no process for a mesher after tries over three seconds,
  /// InternalError if the pool's own process is gone.
  std::vector<GrainResult> mesh(const std::vector<GrainRequest>& requests,
                                const PoolOptions& options);
  /// The same for `count` requests that are made when a mesher is free for them and forgotten when
  /// they are meshed: no more than 10,000 are held at once. Results come in any order.
  void mesh(std::size_t count, const RequestSource& source, const ResultSink& sink,
            const PoolOptions& options);

  /// Meshes of faces by one mesher that is not ours (mesh/face_mesher.hpp), in the order of the
  /// requests and the same for any number of jobs, as for grains. A face that could not be meshed
  /// has its `fault`, which names mesher and face. `options`: timeout and jobs. Throws as above.
  std::vector<PlanarMesh> mesh_faces(const std::vector<FaceRequest>& requests,
                                     const std::string& mesher, const PoolOptions& options);

  /// CPU time of all mesher processes so far [s].
  double cpu_seconds() const;

 private:
  struct Impl;
  class Stream;
  explicit MesherPool(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Why `mesh` is not a mesh of `surface`'s inside: empty if it is (boundary facets identical with
/// the surface triangles, nodes kept, volumes positive and adding up, every node used).
std::string validate(const SurfaceMesh& surface, const VolumeMesh& mesh);

/// Least radius ratio of the tetrahedra (0 for none).
double min_radius_ratio(const VolumeMesh& mesh);

/// O of eqs. (4)-(7), alpha 0.2, beta 0.1; 0 without tetrahedra or with one that is flat.
double mesh_quality_O(const VolumeMesh& mesh, double element_size);

}  // namespace polyslip::mesh
