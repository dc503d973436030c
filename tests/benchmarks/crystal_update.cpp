// CPU microseconds a point of the FCC update, on one thread, with and without the tangent: the
// median of 21 calls on all points, as a Newton iteration of a run makes one.
//   crystal_update [points]
// Cases: flow (a crystal that flows already, step 0.01, the gradient changed by 1 %), from zero
// stress, reversal; with one strength and with twelve.

#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "../unit/material/random_points.hpp"

namespace {

using namespace polyslip;
using material::test::Batch;

double microseconds(Batch& batch, const material::CrystalLaw& law, bool with_tangent) {
  std::vector<double> times;
  for (int repeat = 0; repeat < 21; ++repeat) {
    const std::clock_t start = std::clock();
    batch.run(law, with_tangent);
    times.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::nth_element(times.begin(), times.begin() + 10, times.end());
  return 1e6 * times[10] / batch.points;
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

void measure(double m, double latent_ratio, int points) {
  material::MaterialOptions o;
  o.rate_sensitivity = m;
  o.latent_ratio = latent_ratio;
  const auto law = material::make_fcc_law(o);
  core::Random random(1, core::Stream::tests);
  Batch batch(*law, points);
  for (int p = 0; p < points; ++p) {
    batch.set_state(*law, p, random.rotation());
    batch.set_gradient(p, plane_strain_gradient(0.01, random, 0.3));
  }
  std::printf("m = %.2f, %d g, %d points, step 0.01\n", m, batch.strengths, points);
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

}  // namespace

int main(int argc, char** argv) {
  const int points = argc > 1 ? material::lanes * (std::atoi(argv[1]) / material::lanes) : 8000;
  if (points <= 0) {
    std::fprintf(stderr, "crystal_update [points]: points must be 4 or more\n");
    return 2;
  }
  omp_set_num_threads(1);
  for (const double latent_ratio : {1.0, 1.4}) {
    for (const double m : {0.12, 0.05, 0.02}) measure(m, latent_ratio, points);
  }
  return 0;
}
