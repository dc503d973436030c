// The inf-sup constant of the mixed element on a polycrystal's mesh (docs/verification.md).
// inf_sup WORKER GRAINS ELEMENT_SIZE
#include <fmt/core.h>

#include <cstdlib>

#include "support/polycrystal_mesh.hpp"
#include "support/solver/inf_sup.hpp"

int main(int argc, char** argv) {
  using namespace polyslip;
  if (argc < 4) return 2;
  const auto pool = mesh::MesherPool::start(argv[1]);
  const auto m = tests::polycrystal_mesh(*pool, std::atoi(argv[2]), std::atof(argv[3]));
  fmt::print("{} elements, {} nodes: inf-sup constant {:.3f}\n", m.element_count(), m.node_count(),
             test::inf_sup_constant(m));
  return 0;
}
