#include "mesh/orientation_block.hpp"

#include <fmt/format.h>

#include "core/rotation.hpp"

namespace polyslip::mesh {

void read_orientation_convention(TextScanner& in) {
  const std::string convention(in.word("the convention of the orientations"));
  if (convention != "rodrigues:passive")
    in.fail(fmt::format("orientations are '{}'; only rodrigues:passive is read", convention));
}

core::Quaternion read_orientation(TextScanner& in) {
  core::Vec3 r;
  for (int i = 0; i < 3; ++i) r[i] = in.number("a component of a Rodrigues vector");
  return core::from_rodrigues(r);
}

}  // namespace polyslip::mesh
