// Threads inside a rank change no bit.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <vector>

#include "support/crystal_boxes.hpp"

namespace polyslip::solver {
namespace {

/// Stress and face forces of two steps of four slabs.
std::vector<double> response(int threads) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  const auto law = material::make_fcc_law({});
  Model model(MPI_COMM_WORLD, tests::slab_box(MPI_COMM_WORLD, *law), *law, {}, {}, {});
  std::vector<double> out;
  for (int i = 0; i < 2; ++i) {
    const StepRecord r = model.step(1);
    out.insert(out.end(), r.stress.begin(), r.stress.end());
    for (const auto& force : r.face_forces) out.insert(out.end(), force.begin(), force.end());
    out.push_back(r.linear_iterations);
  }
  omp_set_num_threads(before);
  return out;
}

TEST(Threads, ChangeNoBit) {
  const auto one = response(1);
  EXPECT_GT(std::abs(one[2]), 1);
  EXPECT_EQ(one, response(2));
}

}  // namespace
}  // namespace polyslip::solver
