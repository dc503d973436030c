// CPU microseconds a point of the FCC update, on one thread, with and without the tangent.
//   crystal_update [points]
// Cases: flow (a crystal that flows already, step 0.01, the gradient changed by 1 %), from zero
// stress, reversal.

#include <omp.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "../unit/material/random_points.hpp"

namespace {

using namespace polyslip;
using material::test::Batch;

double microseconds(Batch& batch, const material::CrystalLaw& law, bool with_tangent) {
  double best = 1e300;
  for (int repeat = 0; repeat < 7; ++repeat) {
    const std::clock_t start = std::clock();
    batch.run(law, with_tangent);
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return 1e6 * best / batch.points;
}

core::Mat3 plane_strain_gradient(double step, core::Random& random, double scatter) {
  core::Mat3 l = core::Vec3(1, 0, -1).asDiagonal();
  l += scatter * material::test::random_matrix(random);
  return core::Mat3::Identity() + step * l;
}

void report(const char* name, Batch& batch, const material::CrystalLaw& law) {
  const double with = microseconds(batch, law, true), without = microseconds(batch, law, false);
  std::printf("  %-9s %6.3f us a point with tangent, %6.3f without, %d failed\n", name, with,
              without, batch.failures());
}

}  // namespace

int main(int argc, char** argv) {
  const int points = argc > 1 ? material::lanes * (std::atoi(argv[1]) / material::lanes) : 8000;
  if (points <= 0) {
    std::fprintf(stderr, "crystal_update [points]: points must be 4 or more\n");
    return 2;
  }
  omp_set_num_threads(1);
  for (const double m : {0.12, 0.05, 0.02}) {
    material::MaterialOptions o;
    o.rate_sensitivity = m;
    const auto law = material::make_fcc_law(o);
    core::Random random(1, core::Stream::tests);
    Batch batch(*law, points);
    for (int p = 0; p < points; ++p) {
      batch.set_state(*law, p, random.rotation());
      batch.set_gradient(p, plane_strain_gradient(0.01, random, 0.3));
    }
    std::printf("m = %.2f, %d points, step 0.01\n", m, points);
    report("from zero", batch, *law);
    for (int step = 0; step < 3; ++step) {
      batch.old = batch.fresh;
      batch.run(*law);
    }
    batch.old = batch.fresh;
    for (int p = 0; p < points; ++p) {
      const core::Mat3 change = 1e-4 * material::test::random_matrix(random);
      batch.set_gradient(p, batch.gradient_of(p) + change);
    }
    report("flow", batch, *law);
    for (int p = 0; p < points; ++p) batch.set_gradient(p, batch.gradient_of(p).inverse());
    report("reversal", batch, *law);
  }
  return 0;
}
