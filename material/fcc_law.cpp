// The FCC crystal law: backward-Euler update and consistent tangent (docs/theory-material.md).

#include <algorithm>

#include "core/tensor.hpp"
#include "material/crystal_law.hpp"
#include "material/options_check.hpp"
#include "material/slip_systems.hpp"
#include "material/stress_tangent.hpp"

namespace polyslip::material {

namespace {

using namespace simd;

/// Offsets in the state of a point that has so many strengths.
template <int strengths>
struct Offsets {
  static constexpr int orientation = 0, elastic_strain = 4, strength = 9;
  static constexpr int slip = strength + strengths, equivalent_strain = slip + 1;
  static constexpr int size = equivalent_strain + 1;
};

core::StateLayout fcc_layout(int strengths) {
  using core::Transport;
  return {
      {{"orientation", 4, "1", Transport::orientation_average,
        "unit quaternion w x y z that turns crystal axes into sample axes"},
       {"elastic_strain", 5, "1", Transport::reset_to_zero,
        "deviatoric elastic strain in crystal axes, basis (xx-yy)/sqrt2, "
        "(2zz-xx-yy)/sqrt6, sqrt2 yz, sqrt2 zx, sqrt2 xy"},
       {"g", strengths, "MPa", Transport::element_average,
        strengths == 1 ? "slip strength, the same of all systems"
                       : "slip strengths in the order of the systems (docs/theory-material.md)"},
       {"slip", 1, "1", Transport::element_average, "accumulated sum of |slip| of the systems"},
       {"equivalent_strain", 1, "1", Transport::element_average,
        "accumulated plastic strain, integral of sqrt(2/3 Dp:Dp) dt"}}};
}

SlipConstants slip_constants(const MaterialOptions& options) {
  SlipConstants c = {};
  const auto fcc = fcc_slip_systems();
  for (std::size_t a = 0; a < fcc.size(); ++a) {
    const core::Mat3 schmid = fcc[a].direction * fcc[a].normal.transpose();
    const core::Vec5 p = core::deviator5(schmid);
    std::copy(p.begin(), p.end(), c.schmid[a].begin());
    const core::Vec3 q = core::axial(schmid);
    std::copy(q.begin(), q.end(), c.spin[a].begin());
  }
  const double diagonal = options.c11 - options.c12, shear = 2 * options.c44;
  c.moduli = {diagonal, diagonal, shear, shear, shear};
  c.exponent = 1.0 / options.rate_sensitivity;
  c.reference_rate = options.reference_slip_rate;
  const bool hardens = options.h0 > 0 && options.gs > options.g0;
  if (hardens) {
    c.voce.rate = options.h0 / (options.gs - options.g0);
    c.voce.range = options.gs - options.g0;
    c.voce.exponent = options.voce_exponent;
  }
  c.voce.gs = options.gs;
  c.latent = options.latent_ratio;
  return c;
}

template <class Strength>
void write_state(const SolvedBlock<Strength>& block, const Quaternionv& old,
                 const double* state_old, m4 valid, const SlipConstants& c, double* state_new) {
  using At = Offsets<Strength::strengths>;
  const Slips& slips = block.point.slips;
  Vec3v minus_w;
  for (int k = 0; k < 3; ++k) minus_w[k] = -slips.spin[k];
  Quaternionv q = mul(old, mul(to_quaternion(block.kinematics.rotation), exp_quaternion(minus_w)));
  const v4 scale = copysign(1.0 / sqrt(dot(q, q)), dot(q, old));
  const auto put = [&](int component, v4 value) {
    const v4 kept = load(state_old + lanes * component);
    store(state_new + lanes * component, select(valid, value, kept));
  };
  for (int i = 0; i < 4; ++i) put(At::orientation + i, q[i] * scale);
  for (int i = 0; i < 5; ++i) {
    put(At::elastic_strain + i, block.stress[i] * (1.0 / c.moduli[static_cast<std::size_t>(i)]));
  }
  for (int a = 0; a < Strength::strengths; ++a) put(At::strength + a, block.point.g[a]);
  put(At::slip, load(state_old + lanes * At::slip) + slips.total);
  put(At::equivalent_strain, load(state_old + lanes * At::equivalent_strain) +
                                 sqrt((2.0 / 3) * dot(slips.plastic, slips.plastic)));
}

void write_stress(const Mat3v& trial_rotation, const Mat3v& slip_rotation, const Vec5v& lattice,
                  m4 valid, double* stress) {
  const Mat3v s = conjugate(trial_rotation, conjugate(slip_rotation, to_matrix(lattice)));
  const v4 mandel[6] = {s[0][0],           s[1][1], s[2][2], sqrt_two * s[1][2], sqrt_two * s[2][0],
                        sqrt_two * s[0][1]};
  for (int i = 0; i < 6; ++i) store(stress + lanes * i, select(valid, mandel[i], broadcast(0.0)));
}

/// Fills in everything but the gradient; lanes that are not usable get harmless values.
template <class Strength>
void set_problem(const SlipConstants& c, const double* old, m4 usable, const Vec5v& increment,
                 double time_step, Problem<Strength>& problem) {
  using At = Offsets<Strength::strengths>;
  const Mat3v strain = to_matrix(increment);
  for (int i = 0; i < 5; ++i) {
    problem.elastic_old[i] =
        select(usable, load(old + lanes * (At::elastic_strain + i)), broadcast(0.0));
  }
  problem.strain = increment;
  for (int k = 0; k < 3; ++k) {
    problem.turn[k] = commutator(unit3(k), strain);
    for (int i = 0; i < 5; ++i) problem.turn[k][i] *= 0.5;
  }
  v4 sum = broadcast(0.0);
  for (int a = 0; a < Strength::strengths; ++a) {
    problem.g_old[a] = select(usable, load(old + lanes * (At::strength + a)), broadcast(1.0));
    sum += problem.g_old[a];
  }
  problem.mean_g_old = sum * (1.0 / Strength::strengths);
  problem.dt_rate = time_step * c.reference_rate;
}

/// Strength: SharedStrength or LatentStrength.
template <class Strength>
class FccLaw final : public CrystalLaw {
 public:
  explicit FccLaw(const MaterialOptions& options)
      : options_(options),
        layout_(fcc_layout(Strength::strengths)),
        constants_(slip_constants(options)) {}

  const core::StateLayout& layout() const override { return layout_; }
  double bulk_modulus() const override { return (options_.c11 + 2 * options_.c12) / 3; }
  double shear_modulus() const override {
    return std::max(options_.c44, (options_.c11 - options_.c12) / 2);
  }

  void initial_state(const core::Quaternion& q, double* state) const override {
    std::fill(state, state + At::size, 0.0);
    state[At::orientation] = q.w();
    state[At::orientation + 1] = q.x();
    state[At::orientation + 2] = q.y();
    state[At::orientation + 3] = q.z();
    std::fill_n(state + At::strength, Strength::strengths, options_.g0);
  }

  void update(const PointBlocks& blocks) const override {
#pragma omp parallel for schedule(static)
    for (int block = 0; block < blocks.n_blocks; ++block) update_block(blocks, block);
  }

 private:
  using At = Offsets<Strength::strengths>;
  void update_block(const PointBlocks& blocks, int index) const;

  MaterialOptions options_;
  core::StateLayout layout_;
  SlipConstants constants_;
};

template <class Strength>
void FccLaw<Strength>::update_block(const PointBlocks& blocks, int index) const {
  const auto at = static_cast<std::size_t>(index) * lanes;
  const double* old = blocks.state_old + at * At::size;
  SolvedBlock<Strength> block;
  Quaternionv q;
  v4 sum = broadcast(0.0), weakest = load(old + lanes * At::strength);
  for (int i = 0; i < At::size; ++i) sum += abs(load(old + lanes * i));
  for (int i = 0; i < 4; ++i) q[i] = load(old + lanes * (At::orientation + i));
  for (int a = 1; a < Strength::strengths; ++a) {
    weakest = min(weakest, load(old + lanes * (At::strength + a)));
  }
  const m4 usable = finite(sum) & (dot(q, q) > 0.0) & (weakest > 0.0);
  for (int i = 0; i < 4; ++i) q[i] = select(usable, q[i], broadcast(i == 0 ? 1.0 : 0.0));
  const Mat3v rotation = to_matrix(q);

  Mat3v f;
  v4 f_sum = broadcast(0.0);
  for (int i = 0; i < 9; ++i) {
    f[i / 3][i % 3] = load(blocks.relative_gradient + lanes * (at / lanes * 9 + i));
    f_sum += abs(f[i / 3][i % 3]);
  }
  const m4 numbers = usable & finite(f_sum);
  block.kinematics = step_kinematics(conjugate(transpose(rotation), f));
  const m4 solvable = usable & block.kinematics.valid;

  set_problem<Strength>(constants_, old, usable, block.kinematics.strain, blocks.time_step,
                        block.problem);
  const m4 valid = solve_slip(constants_, block.problem, block.point) & solvable;
  for (int i = 0; i < 5; ++i) block.stress[i] = block.point.scale() * block.point.reduced(i);

  block.trial_rotation = mul(rotation, block.kinematics.rotation);
  Vec3v minus_w;
  for (int k = 0; k < 3; ++k) minus_w[k] = -block.point.slips.spin[k];
  block.slip_rotation = to_matrix(exp_quaternion(minus_w));
  write_state(block, q, old, valid, constants_, blocks.state_new + at * At::size);
  write_stress(block.trial_rotation, block.slip_rotation, block.stress, valid,
               blocks.stress + at * 6);
  if (blocks.tangent != nullptr) {
    write_tangent(constants_, block, valid, blocks.tangent + at * 54);
  }
  for (int lane = 0; lane < lanes; ++lane) {
    blocks.status[at + static_cast<std::size_t>(lane)] = valid[lane] != 0 ? PointStatus::converged
                                                         : numbers[lane] != 0
                                                             ? PointStatus::not_converged
                                                             : PointStatus::not_finite;
  }
}

}  // namespace

std::unique_ptr<CrystalLaw> make_fcc_law(const MaterialOptions& options) {
  check(options);
  if (options.latent_ratio == 1.0) return std::make_unique<FccLaw<SharedStrength>>(options);
  return std::make_unique<FccLaw<LatentStrength>>(options);
}

}  // namespace polyslip::material
