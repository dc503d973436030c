#include "drivers/remeshing_attempts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace polyslip::drivers {
namespace {

/// Those that optimise, whether the deck names them or not.
constexpr std::array<const char*, 3> optimising_meshers{"gmsh-hxt", "gmsh-delaunay", "netgen"};

void scale_sizes(mesh::MeshingOptions& meshing, double factor) {
  meshing.element_size *= factor;
  if (meshing.outer_element_size) *meshing.outer_element_size *= factor;
  for (double& size : meshing.grain_element_sizes) size *= factor;
}

}  // namespace

std::vector<RemeshingAttempt> remeshing_attempts(const Options& options) {
  std::vector<RemeshingAttempt> attempts{{"as the deck says", options.mesh, options.remeshing}};

  RemeshingAttempt next = attempts.back();
  if (next.remeshing.transport.stress != "zero") {
    next.what = "with stresses zero";
    next.remeshing.transport.stress = "zero";
    attempts.push_back(next);
  }
  next.what = "every mesher on every grain";
  next.meshing.mesher_target = 1;
  auto& meshers = next.meshing.meshers;
  for (const char* name : optimising_meshers)
    if (std::find(meshers.begin(), meshers.end(), name) == meshers.end()) meshers.push_back(name);
  attempts.push_back(next);

  constexpr double smaller = 0.8;
  next.what = fmt::format("that, with elements {:g} times as large", smaller);
  scale_sizes(next.meshing, smaller);
  attempts.push_back(next);

  next = *std::prev(attempts.end(), 2);
  next.remeshing.orthotropic_share /= 2;
  if (next.remeshing.orthotropic_share > 0) {
    next.what =
        fmt::format("every mesher, orthotropic_share = {:g}", next.remeshing.orthotropic_share);
    attempts.push_back(next);
  }
  return attempts;
}

}  // namespace polyslip::drivers
