// Starts the mesher pool before MPI, as the pool asks, then runs the tests on one rank.
#include <gtest/gtest.h>

#include <memory>

#include "mesh/geometry.hpp"
#include "meshes.hpp"
#include "solver/petsc_session.hpp"

namespace polyslip::tests {
namespace {
std::unique_ptr<mesh::MesherPool> pool;
}

mesh::Mesh unstructured_cube(double element_size) {
  const auto cube = mesh::voronoi_tessellation({core::Vec3(0.5, 0.5, 0.5)}, {1, 1, 1});
  mesh::MeshingOptions options;
  options.element_size = element_size;
  options.meshers = {"gmsh-delaunay"};
  mesh::MeshingReport report;
  return mesh::mesh_geometry(mesh::geometry_of(cube), options, {1, 1, 1}, *pool, report);
}
}  // namespace polyslip::tests

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  polyslip::tests::pool = polyslip::mesh::MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  int failed = 0;
  {
    const polyslip::solver::PetscSession session;
    failed = RUN_ALL_TESTS();
  }
  polyslip::tests::pool.reset();
  return failed;
}
