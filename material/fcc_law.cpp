// The FCC crystal law: backward-Euler update and consistent tangent (docs/theory-material.md).

#include <algorithm>

#include "core/tensor.hpp"
#include "material/crystal_law.hpp"
#include "material/kinematics.hpp"
#include "material/options_check.hpp"
#include "material/slip_solver.hpp"
#include "material/slip_systems.hpp"

namespace polyslip::material {

namespace {

using namespace simd;

// Offsets in the state of a point.
constexpr int orientation = 0, elastic_strain = 4, strength = 9, slip = 10, equivalent_strain = 11;
constexpr int state_size = 12;

core::StateLayout fcc_layout() {
  using core::Transport;
  return {{{"orientation", 4, "1", Transport::orientation_average,
            "unit quaternion w x y z that turns crystal axes into sample axes"},
           {"elastic_strain", 5, "1", Transport::reset_to_zero,
            "deviatoric elastic strain in crystal axes, basis (xx-yy)/sqrt2, "
            "(2zz-xx-yy)/sqrt6, sqrt2 yz, sqrt2 zx, sqrt2 xy"},
           {"g", 1, "MPa", Transport::element_average, "slip strength"},
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
  c.voce = hardens ? options.h0 / (options.gs - options.g0) : 0.0;
  c.gs = options.gs;
  return c;
}

/// What update() knows of a block after the state has been found.
struct SolvedBlock {
  StepKinematics kinematics;  ///< crystal frame of n
  Mat3v trial_rotation;       ///< R_n r: crystal frame of n, rotated by the step, to sample
  Mat3v slip_rotation;        ///< exp(-hat(w))
  SlipProblem problem;
  SlipPoint point;
  Vec5v stress;  ///< s = g x, lattice frame [MPa]
};

/// dstress/dh, (M.16) to (M.18), entry 9 i + 3 k + l at tangent + lanes (9 i + 3 k + l).
void write_tangent(const SlipConstants& c, const SolvedBlock& block, m4 valid, double* tangent) {
  const SlipJacobian derivative = jacobian(c, block.problem, block.point);
  const Factors factors = factorise(derivative.rows);
  const StepKinematicsDerivative kinematics = step_kinematics_derivative(block.kinematics);
  const Mat3v& e = block.slip_rotation;
  const Mat3v turned = conjugate(e, to_matrix(block.stress));  // rotated frame of n
  Vec3v minus_w;
  for (int k = 0; k < 3; ++k) minus_w[k] = -block.point.spin[k];
  const Mat3v exp_rate = exp_derivative(minus_w);
  Vec5v turn[3];  // of the stress in the rotated frame of n by its lattice spin
  for (int k = 0; k < 3; ++k) turn[k] = commutator(unit3(k), turned);

  // rows[i][p][q]: d stress_i / d H_pq, both in the rotated crystal frame of n
  Mat3v rows[5] = {};
  const auto add = [](Mat3v& sum, v4 factor, const Mat3v& term) {
    for (int p = 0; p < 3; ++p) {
      for (int q = 0; q < 3; ++q) sum[p][q] += factor * term[p][q];
    }
  };
  for (int j = 0; j < 5; ++j) {
    Vec5v load = commutator(block.point.spin, to_matrix(unit5(j)));
    for (int i = 0; i < 5; ++i) load[i] *= 0.5;
    load[j] += 1.0;
    const Vec5v dx = solve(factors, load);
    const v4 dg = dot(derivative.strength, dx);
    Vec5v ds;
    for (int i = 0; i < 5; ++i) ds[i] = block.point.g * dx[i] + block.point.reduced[i] * dg;
    const Vec5v ds_turned = to_deviator(conjugate(e, to_matrix(ds)));
    Vec3v dw, rotation;
    for (int k = 0; k < 3; ++k) {
      dw[k] = broadcast(0.0);
      for (int i = 0; i < 5; ++i) dw[k] += derivative.spin[i][k] * dx[i];
    }
    for (int k = 0; k < 3; ++k) {
      rotation[k] = exp_rate[k][0] * dw[0] + exp_rate[k][1] * dw[1] + exp_rate[k][2] * dw[2];
    }
    for (int i = 0; i < 5; ++i) {
      v4 entry = ds_turned[i];
      for (int k = 0; k < 3; ++k) entry -= turn[k][i] * rotation[k];
      add(rows[i], entry, kinematics.strain[j]);
    }
  }
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 3; ++k) add(rows[i], turn[k][i], kinematics.spin[k]);
  }

  const Mat3v& r = block.trial_rotation;
  Mat3v basis[5];
  for (int j = 0; j < 5; ++j) {
    rows[j] = conjugate(r, rows[j]);
    basis[j] = conjugate(r, to_matrix(unit5(j)));
  }
  constexpr int first[6] = {0, 1, 2, 1, 2, 0}, second[6] = {0, 1, 2, 2, 0, 1};
  for (int i = 0; i < 6; ++i) {
    const double mandel = i < 3 ? 1.0 : sqrt_two;
    for (int kl = 0; kl < 9; ++kl) {
      v4 entry = broadcast(0.0);
      for (int j = 0; j < 5; ++j) {
        entry += mandel * basis[j][first[i]][second[i]] * rows[j][kl / 3][kl % 3];
      }
      store(tangent + lanes * (9 * i + kl), select(valid, entry, broadcast(0.0)));
    }
  }
}

void write_state(const SolvedBlock& block, const Quaternionv& old, const double* state_old,
                 m4 valid, const SlipConstants& c, double* state_new) {
  Vec3v minus_w;
  for (int k = 0; k < 3; ++k) minus_w[k] = -block.point.spin[k];
  Quaternionv q = mul(old, mul(to_quaternion(block.kinematics.rotation), exp_quaternion(minus_w)));
  const v4 scale = copysign(1.0 / sqrt(dot(q, q)), dot(q, old));
  const auto put = [&](int component, v4 value) {
    const v4 kept = load(state_old + lanes * component);
    store(state_new + lanes * component, select(valid, value, kept));
  };
  for (int i = 0; i < 4; ++i) put(orientation + i, q[i] * scale);
  for (int i = 0; i < 5; ++i) {
    put(elastic_strain + i, block.stress[i] * (1.0 / c.moduli[static_cast<std::size_t>(i)]));
  }
  put(strength, block.point.g);
  put(slip, load(state_old + lanes * slip) + block.point.total);
  put(equivalent_strain, load(state_old + lanes * equivalent_strain) +
                             sqrt((2.0 / 3) * dot(block.point.plastic, block.point.plastic)));
}

void write_stress(const SolvedBlock& block, m4 valid, double* stress) {
  const Mat3v s =
      conjugate(block.trial_rotation, conjugate(block.slip_rotation, to_matrix(block.stress)));
  const v4 mandel[6] = {s[0][0],           s[1][1], s[2][2], sqrt_two * s[1][2], sqrt_two * s[2][0],
                        sqrt_two * s[0][1]};
  for (int i = 0; i < 6; ++i) store(stress + lanes * i, select(valid, mandel[i], broadcast(0.0)));
}

class FccLaw final : public CrystalLaw {
 public:
  explicit FccLaw(const MaterialOptions& options)
      : options_(options), layout_(fcc_layout()), constants_(slip_constants(options)) {}

  const core::StateLayout& layout() const override { return layout_; }
  double bulk_modulus() const override { return (options_.c11 + 2 * options_.c12) / 3; }
  double shear_modulus() const override {
    return std::max(options_.c44, (options_.c11 - options_.c12) / 2);
  }

  void initial_state(const core::Quaternion& q, double* state) const override {
    std::fill(state, state + state_size, 0.0);
    state[orientation] = q.w();
    state[orientation + 1] = q.x();
    state[orientation + 2] = q.y();
    state[orientation + 3] = q.z();
    state[strength] = options_.g0;
  }

  void update(const PointBlocks& blocks) const override {
#pragma omp parallel for schedule(static)
    for (int block = 0; block < blocks.n_blocks; ++block) update_block(blocks, block);
  }

 private:
  void update_block(const PointBlocks& blocks, int index) const;

  MaterialOptions options_;
  core::StateLayout layout_;
  SlipConstants constants_;
};

void FccLaw::update_block(const PointBlocks& blocks, int index) const {
  const auto at = static_cast<std::size_t>(index) * lanes;
  const double* old = blocks.state_old + at * state_size;
  SolvedBlock block;
  Quaternionv q;
  v4 sum = broadcast(0.0);
  for (int i = 0; i < state_size; ++i) sum += abs(load(old + lanes * i));
  for (int i = 0; i < 4; ++i) q[i] = load(old + lanes * (orientation + i));
  const v4 g_old = load(old + lanes * strength);
  const m4 usable = finite(sum) & (dot(q, q) > 0.0) & (g_old > 0.0);
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

  SlipProblem& problem = block.problem;
  const Mat3v strain = to_matrix(block.kinematics.strain);
  for (int i = 0; i < 5; ++i) {
    problem.elastic_old[i] =
        select(usable, load(old + lanes * (elastic_strain + i)), broadcast(0.0));
  }
  problem.strain = block.kinematics.strain;
  for (int k = 0; k < 3; ++k) {
    problem.turn[k] = commutator(unit3(k), strain);
    for (int i = 0; i < 5; ++i) problem.turn[k][i] *= 0.5;
  }
  problem.g_old = select(usable, g_old, broadcast(1.0));
  problem.dt_rate = blocks.time_step * constants_.reference_rate;
  const m4 valid = solve_slip(constants_, problem, block.point) & solvable;
  for (int i = 0; i < 5; ++i) block.stress[i] = block.point.g * block.point.reduced[i];

  block.trial_rotation = mul(rotation, block.kinematics.rotation);
  Vec3v minus_w;
  for (int k = 0; k < 3; ++k) minus_w[k] = -block.point.spin[k];
  block.slip_rotation = to_matrix(exp_quaternion(minus_w));
  write_state(block, q, old, valid, constants_, blocks.state_new + at * state_size);
  write_stress(block, valid, blocks.stress + at * 6);
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
  return std::make_unique<FccLaw>(options);
}

}  // namespace polyslip::material
