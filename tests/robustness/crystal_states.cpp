// Not one of a million random states may fail: crystals of aluminium, copper and nearly isotropic
// tungsten, one strength or twelve, stresses from zero to beyond flow, strain increments from 1e-5
// to 0.05 at rates from 1e-6 to 1e3 /s, then the way back, for each exponent 1/m.
//   crystal_states [states] [seed]      states for each exponent; 20,000 if not given
// Prints a line for each exponent and kind; ends with 1 if a state failed.

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "../unit/material/random_points.hpp"

namespace {

using namespace polyslip;
using material::MaterialOptions;
using material::test::Batch;

constexpr int batch_size = 1000;
constexpr double exponents[] = {1 / 0.3, 8, 20, 50, 100};

double log_uniform(core::Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

MaterialOptions random_material(core::Random& random, double exponent, bool twelve) {
  struct Metal {
    double c11, c12, c44, g0;  // MPa
  };
  static constexpr Metal metals[] = {
      {107.3e3, 60.9e3, 28.3e3, 8}, {168.4e3, 121.4e3, 75.4e3, 16}, {522e3, 204e3, 160.6e3, 300}};
  const Metal& metal = metals[static_cast<int>(3 * random.uniform()) % 3];
  MaterialOptions o;
  o.c11 = metal.c11;
  o.c12 = metal.c12;
  o.c44 = metal.c44;
  o.rate_sensitivity = 1 / exponent;
  o.g0 = metal.g0;
  o.gs = o.g0 * random.uniform(1.0, 5.0);
  o.h0 = o.g0 * log_uniform(random, 0.1, 20.0);
  o.voce_exponent = random.uniform() < 0.5 ? 1.0 : random.uniform(0.3, 3.0);
  if (twelve) o.latent_ratio = random.uniform(0.0, 1.8);
  return o;
}

struct Count {
  long states = 0, failed = 0, wrong = 0;
};

/// Fails, or gives strengths that fall or leave their bounds, or stresses that are no numbers.
void check(const Batch& batch, const MaterialOptions& o, Count& count) {
  count.states += batch.points;
  count.failed += batch.failures();
  for (int p = 0; p < batch.points; ++p) {
    bool right = batch.stress_of(p).allFinite();
    for (int a = batch.strength; a < batch.slip; ++a) {
      const double g = batch.new_state(p, a),
                   old = batch.old[material::test::lane_index(p, a, batch.components)];
      right = right && g >= old && g <= o.gs * (1 + 1e-14);
    }
    count.wrong += right ? 0 : 1;
  }
}

/// A batch of random states, then each of them reversed.
void run(core::Random& random, double exponent, bool twelve, Count& count) {
  const MaterialOptions o = random_material(random, exponent, twelve);
  const auto law = material::make_fcc_law(o);
  Batch batch(*law, batch_size);
  const double increment = log_uniform(random, 1e-5, 0.05), rate = log_uniform(random, 1e-6, 1e3);
  batch.time_step = increment / rate;
  const double flow = std::pow(rate, o.rate_sensitivity);  // tau/g of slip at this rate
  for (int p = 0; p < batch_size; ++p) {
    batch.set_state(*law, p, random.rotation());
    const double level = p % 4 == 0 ? 0.0 : flow * random.uniform(0.0, 1.3);
    const core::Vec5 e = material::test::random_elastic(random, o, level);
    for (int i = 0; i < 5; ++i) batch.old_state(p, 4 + i) = e[i];
    for (int a = batch.strength; a < batch.slip; ++a) {
      batch.old_state(p, a) = random.uniform(o.g0, o.gs);
    }
    const core::Mat3 l = material::test::random_matrix(random);
    const double size = increment * random.uniform(0.2, 1.0) / core::symmetric_part(l).norm();
    batch.set_gradient(p, core::Mat3::Identity() + size * l);
  }
  batch.run(*law);
  check(batch, o, count);
  if (batch.failures() > 0) return;
  batch.old = batch.fresh;
  for (int p = 0; p < batch_size; ++p) batch.set_gradient(p, batch.gradient_of(p).inverse());
  batch.run(*law);
  check(batch, o, count);
}

}  // namespace

int main(int argc, char** argv) {
  const long states = argc > 1 ? std::atol(argv[1]) : 20000;
  core::Random random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1, core::Stream::tests);
  if (states <= 0) {
    std::fprintf(stderr, "crystal_states [states] [seed]: states must be positive\n");
    return 2;
  }
  bool good = true;
  for (const double exponent : exponents) {
    for (const bool twelve : {false, true}) {
      Count count;
      const std::clock_t start = std::clock();
      while (count.states < states) run(random, exponent, twelve, count);
      const double cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      std::printf("1/m = %5.1f, %s: %ld states, %ld failed, %ld wrong, %.0f CPU s\n", exponent,
                  twelve ? "twelve g" : "one g   ", count.states, count.failed, count.wrong, cpu);
      std::fflush(stdout);
      good = good && count.failed == 0 && count.wrong == 0;
    }
  }
  return good ? 0 : 1;
}
