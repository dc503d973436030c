#pragma once
// A motion of a polycrystal without a solver: plane-strain compression and, over it, a smooth
// random flow of about a grain's wavelength that keeps volumes and the flat faces of the box flat.

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace polyslip::test {

/// d x/d eps = (x, 0, -z) + D u(D^-1 x), D = diag(e^eps, 1, e^-eps): u is steady in the frame
/// scaled back to isotropy, in which grains keep their shape but for it. u = curl A, so that it has
/// no divergence; A's components tangential to the faces x0, y0, y1, z0, z1 of the box [0, size]
/// vanish on them, so that these stay planes. The face x1 is free and becomes curved.
class GrainFlow {
 public:
  struct Options {
    double strength = 0.2;    ///< root mean square of |grad u| in the box
    double wavelength = 1.5;  ///< of u's waves, from 0.7 to 1.4 times as long
    std::uint64_t seed = 1;
  };
  GrainFlow(const core::Vec3& size, const Options& options);

  /// d x/d eps at a strain.
  core::Vec3 velocity(const core::Vec3& x, double strain) const;
  /// Moves all nodes from one strain to another (Runge-Kutta, steps of at most 0.02).
  void move(mesh::Mesh& mesh, double from, double to) const;

 private:
  /// One wave of a component of A: sin along the directions in which it has to vanish at both ends
  /// or at the start, cos along the others.
  struct Wave {
    int component = 0;
    double amplitude = 0;
    std::array<double, 3> number{}, phase{};
  };
  core::Vec3 flow(const core::Vec3& x) const;

  core::Vec3 size_;
  std::vector<Wave> waves_;
};

/// Least and mean radius ratio of the straight elements with positions scaled component by
/// component.
mesh::QualitySummary scaled_quality(const mesh::Mesh& mesh, const core::Vec3& scale);

}  // namespace polyslip::test
