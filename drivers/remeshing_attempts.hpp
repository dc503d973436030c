#pragma once
// What is tried, one after another, until a remeshing succeeds.

#include <string>
#include <vector>

#include "drivers/options.hpp"

namespace polyslip::drivers {

struct RemeshingAttempt {
  std::string what;  ///< for the log; the first: "as the deck says"
  mesh::MeshingOptions meshing;
  remap::RemeshingOptions remeshing;
};

/// First as the deck says; then, if stresses are carried, with stresses zero; then every mesher on
/// every grain; then these with smaller elements; then with sizes that follow the shortening half
/// as far as the deck says.
std::vector<RemeshingAttempt> remeshing_attempts(const Options& options);

}  // namespace polyslip::drivers
