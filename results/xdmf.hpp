#pragma once
// results.xdmf: the stored states as one time series for ParaView, meshes differing in time.

#include <string>
#include <vector>

namespace polyslip::results {

/// Mesh number of states that have no mesh (orientations of a Taylor model).
inline constexpr int no_mesh = -1;

/// What the index knows of a stored state.
struct StateRecord {
  std::string file;   ///< name in results/
  double strain = 0;  ///< ln(h0/h)
  double time = 0;    ///< s
  int mesh_number = 0;
  int order = 2;
  long nodes = 0, elements = 0;
};

/// Text of the XDMF file (version 3; heavy data by paths relative to the run folder). Times are
/// the states'; where two are equal (both sides of a remeshing) the later is larger by 1e-9 of
/// itself, so that readers keep both.
std::string xdmf_text(const std::vector<StateRecord>& states);

}  // namespace polyslip::results
