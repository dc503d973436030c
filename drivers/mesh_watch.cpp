#include "drivers/mesh_watch.hpp"

namespace polyslip::drivers {

void MeshWatch::watch(const mesh::Snapshot& snapshot) {
  tetrahedra_ = snapshot.mesh.tetrahedra;
  initial_ = remap::initial_positions(snapshot);
}

remap::Wear MeshWatch::measure(const std::vector<core::Vec3>& positions,
                               const std::vector<core::Vec3>& rates) const {
  return remap::measure_wear(tetrahedra_, positions, rates,
                             remap::isotropy_frame(initial_, positions), options_, threads_);
}

}  // namespace polyslip::drivers
