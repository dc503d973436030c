#pragma once
// Faults on demand, for tests of what a broken mesher costs.

#include <string>
#include <vector>

#include "mesh/face_mesher.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh::worker {

/// The environment variable POLYSLIP_MESHER_FAULT="mesher:grain:kind[,mesher:grain:kind...]" makes
/// that mesher fail on that grain, or a mesher of faces on that face. Kinds: `crash` (segmentation
/// fault), `hang` (an endless loop), `throw` (an exception), `nan` (a node that is not a number,
/// unseen by the mesher process), `garbage` (an answer that is no message), `move` (a node of the
/// surface a little off its place). An entry that cannot be read is ignored. `unoptimised` is no
/// fault: our own optimiser is left out. "fork:N:refuse" makes the first N forks of the server
/// fail.
class FaultInjection {
 public:
  static FaultInjection from_environment();
  /// Number of forks that fail.
  int refused_forks() const;
  /// Before the mesher: crash, hang, throw.
  void before(const std::string& mesher, int grain) const;
  /// Our own optimiser is left out for this grain.
  bool unoptimised(const std::string& mesher, int grain) const;
  /// After the mesher's mesh was found valid: nan, garbage (written to the socket).
  void after(const std::string& mesher, int grain, VolumeMesh& mesh, int socket) const;
  void after(const std::string& mesher, int face, PlanarMesh& mesh, int socket) const;

 private:
  struct Entry {
    std::string mesher;
    int grain = 0;
    std::string kind;
  };
  bool asked(const std::string& mesher, int grain, const std::string& kind) const;
  std::vector<Entry> entries_;
};

}  // namespace polyslip::mesh::worker
