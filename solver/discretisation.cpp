#include "solver/discretisation.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "solver/exchange.hpp"
#include "solver/secant_tangent.hpp"

namespace polyslip::solver {
std::string describe(Evaluation evaluation) {
  switch (evaluation) {
    case Evaluation::fine:
      return "fine";
    case Evaluation::inverted:
      return "an element turned inside out (det J <= 0)";
    case Evaluation::point_failed:
      return "the material update did not converge at a point";
    case Evaluation::not_finite:
      return "a force is not finite";
  }
  return "unknown";
}

Discretisation::Discretisation(const LocalMesh& local, const NodeExchange& exchange,
                               const material::CrystalLaw& law, bool mixed, const PointRule& rule,
                               const std::vector<double>& x, std::vector<double> reference_volume)
    : local_(local),
      exchange_(exchange),
      law_(law),
      mixed_(mixed),
      rule_(rule),
      slots_(static_cast<std::size_t>(rule.slots)),
      bulk_(law.bulk_modulus()),
      shear_(law.shear_modulus()),
      reference_volumes_(std::move(reference_volume)) {
  const std::size_t n = local.elements.size();
  volumes_.assign(n, 0);
  volume_gap_.assign(n, 0);
  jacobian_ratios_.assign(n, 0);
  volume_ratio_.assign(n * slots_, 1);
  step_ratio_.assign(n * slots_, 1);
  f_.assign(n * 9 * slots_, 0);
  state_.assign(n * law.layout().size() * slots_, 0);
  stress_.assign(n * 6 * slots_, 0);
  tangent_.assign(n * 54 * slots_, 0);
  mean_stress_.assign(n * slots_, 0);
  status_.assign(n * slots_, material::PointStatus::converged);
  forces_.assign(static_cast<std::size_t>(local.local_nodes) * 3, 0);
  if (mixed_) {
    for (auto* v : {&scale_, &C_, &W_, &schur_}) v->assign(n, 0);
    for (auto* v : {&reference_, &departure_}) v->assign(n * slots_, 0);
  }
  if (!reference_volumes_.empty() && reference_volumes_.size() != n)
    throw core::InternalError("Discretisation: wrong number of reference volumes");
  const bool compute = broadcast(local.comm, reference_volumes_.empty());
  if (!compute) return;
  int failed = 0;
  reference_volumes_.resize(n);
  for (std::size_t e = 0; e < n; ++e) {
    ElementGeometry geometry;
    if (!element_geometry(rule_, positions(static_cast<int>(e), x), geometry)) failed = 1;
    reference_volumes_[e] = geometry.volume;
  }
  if (maximum(local.comm, failed) != 0)
    throw core::InternalError("Discretisation: the mesh has an element with det J <= 0");
}

ElementPositions Discretisation::positions(int element, const std::vector<double>& x) const {
  ElementPositions out;
  for (int a = 0; a < element_nodes; ++a) {
    const double* at = &x[3 * static_cast<std::size_t>(local_.elements[element][a])];
    out[a] = {at[0], at[1], at[2]};
  }
  return out;
}

bool Discretisation::geometry_of(std::size_t element, ElementGeometry& geometry) const {
  return element_geometry(rule_, positions(static_cast<int>(element), x_), geometry);
}

Evaluation Discretisation::evaluate(const Configuration& old, const std::vector<double>& x,
                                    const std::vector<double>& p, double time_step, double kappa) {
  x_ = x;
  kappa_ = kappa;
  Evaluation outcome = kinematics(old);
  if (outcome == Evaluation::fine) outcome = update_material(old, time_step);
  outcome = static_cast<Evaluation>(maximum(local_.comm, static_cast<int>(outcome)));
  if (outcome != Evaluation::fine) return outcome;
  for (std::size_t e = 0; e < local_.elements.size(); ++e) {
    if (mixed_) {
      std::fill_n(&mean_stress_[slots_ * e], slots_, p[e]);
      add_point_volumes(e);
      volume_gap_[e] = std::log(volumes_[e] / reference_volumes_[e]) - p[e] / bulk_;
      continue;
    }
    for (std::size_t at = slots_ * e; at < slots_ * (e + 1); ++at)
      mean_stress_[at] = bulk_ * std::log(volume_ratio_[at]);
  }
  sum_forces();
  double total = 0;
  for (double r : forces_) total += std::abs(r);
  for (double g : volume_gap_) total += std::abs(g);
  const int bad = std::isfinite(total) ? 0 : 1;
  return maximum(local_.comm, bad) != 0 ? Evaluation::not_finite : Evaluation::fine;
}

PointVolumeResistance Discretisation::resistance(std::size_t e,
                                                 const ElementGeometry& geometry) const {
  return point_volume_resistance(geometry, &step_ratio_[slots_ * e], kappa_);
}

void Discretisation::add_point_volumes(std::size_t e) {
  ElementGeometry geometry;
  geometry_of(e, geometry);
  const auto p = resistance_mean_stress(resistance(e, geometry), geometry);
  for (std::size_t q = 0; q < slots_; ++q) mean_stress_[slots_ * e + q] += p[q];
}

Evaluation Discretisation::kinematics(const Configuration& old) {
  const Stage stage(exchange_.profile(), "kinematics");
  int failed = 0;
  const int n = local_.element_count();
#pragma omp parallel for schedule(static) reduction(max : failed)
  for (int e = 0; e < n; ++e) {
    const auto first = static_cast<std::size_t>(e) * slots_;
    ElementGeometry geometry;
    double* f = &f_[9 * first];
    if (!geometry_of(static_cast<std::size_t>(e), geometry) ||
        !relative_gradients(positions(e, old.x), positions(e, x_), geometry, f)) {
      failed = 1;
      continue;
    }
    volumes_[e] = geometry.volume;
    jacobian_ratios_[e] = geometry.min_jacobian_ratio;
    for (int q = 0; q < rule_.slots; ++q) {
      const auto F = [&](int i, int j) { return f[PointRule::at(9, 3 * i + j, q)]; };
      const double det = F(0, 0) * (F(1, 1) * F(2, 2) - F(1, 2) * F(2, 1)) -
                         F(0, 1) * (F(1, 0) * F(2, 2) - F(1, 2) * F(2, 0)) +
                         F(0, 2) * (F(1, 0) * F(2, 1) - F(1, 1) * F(2, 0));
      const std::size_t at = first + static_cast<std::size_t>(q);
      step_ratio_[at] = det;
      volume_ratio_[at] = old.volume_ratio[at] * det;
    }
  }
  return failed != 0 ? Evaluation::inverted : Evaluation::fine;
}

Evaluation Discretisation::update_material(const Configuration& old, double time_step) {
  const Stage stage(exchange_.profile(), "material");
  material::PointBlocks blocks;
  blocks.n_blocks = local_.element_count() * rule_.blocks;
  blocks.time_step = time_step;
  blocks.relative_gradient = f_.data();
  blocks.state_old = old.state.data();
  blocks.state_new = state_.data();
  blocks.stress = stress_.data();
  blocks.tangent = tangent_.data();
  blocks.status = status_.data();
  law_.update(blocks);
  const bool fine = std::all_of(status_.begin(), status_.end(), [](material::PointStatus s) {
    return s == material::PointStatus::converged;
  });
  return fine ? Evaluation::fine : Evaluation::point_failed;
}

void Discretisation::sum_forces() {
  const Stage stage(exchange_.profile(), "forces");
  // Some elements at a time, by all threads; then added in their order.
  constexpr int batch = 1024;
  const int n = local_.element_count();
  std::vector<ElementForces> r(static_cast<std::size_t>(std::min(n, batch)));
  std::fill(forces_.begin(), forces_.end(), 0.0);
  for (int first = 0; first < n; first += batch) {
    const int count = std::min(batch, n - first);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < count; ++k) {
      const auto e = static_cast<std::size_t>(first + k), at = e * slots_;
      ElementGeometry geometry;
      geometry_of(e, geometry);
      element_forces(geometry, &stress_[6 * at], &mean_stress_[at], r[k]);
    }
    for (int k = 0; k < count; ++k)
      for (int a = 0; a < element_nodes; ++a)
        for (int i = 0; i < 3; ++i)
          forces_[3 * static_cast<std::size_t>(local_.elements[first + k][a]) + i] += r[k][a][i];
  }
  exchange_.add_ghosts(forces_, 3);
}

double Discretisation::augmentation(double modulus, double weight) const {
  return std::min(weight * modulus, bulk_);
}

void Discretisation::linearise_element(std::size_t e, double weight) {
  ElementGeometry geometry;
  geometry_of(e, geometry);
  const double mu =
      std::max(element_shear_modulus(geometry, &tangent_[54 * e * slots_]), 1e-6 * shear_);
  const double V = geometry.volume, w = augmentation(mu, weight) / V, compliance = V / bulk_;
  ElementForces b;
  element_volume_gradient(geometry, b);
  double squares = 0;
  for (const auto& node : b)
    for (double component : node) squares += component * component;
  scale_[e] = w * std::sqrt(squares);
  const double d2 = scale_[e] * scale_[e];
  C_[e] = d2 * compliance;
  W_[e] = w / d2;
  schur_[e] = d2 * (compliance + (1 - w * compliance) / (mu / V + w));
  const PointVolumeResistance r = resistance(e, geometry);
  for (std::size_t q = 0; q < slots_; ++q) {
    reference_[slots_ * e + q] = r.reference[q];
    departure_[slots_ * e + q] = r.s[q];
  }
}

void Discretisation::match_last_change(std::size_t e) {
  ElementGeometry geometry;
  geometry_of(e, geometry);
  ElementPositions u = positions(static_cast<int>(e), x_);
  const ElementPositions before = positions(static_cast<int>(e), linearised_x_);
  for (std::size_t a = 0; a < element_nodes; ++a)
    for (std::size_t i = 0; i < 3; ++i) u[a][i] -= before[a][i];
  double h[9 * max_element_slots], change[6 * material::lanes];
  displacement_gradients(u, geometry, h);
  // Twice the elastic one: finite increments are not quite those of a chord.
  const double stiffest = 4 * shear_;
  for (std::size_t block = 0; block < static_cast<std::size_t>(rule_.blocks); ++block) {
    const std::size_t at = slots_ * e + material::lanes * block;
    for (std::size_t k = 0; k < 6 * material::lanes; ++k)
      change[k] = stress_[6 * at + k] - linearised_stress_[6 * at + k];
    solver::match_last_change(h + 9 * material::lanes * block, change, stiffest,
                              &tangent_[54 * at]);
  }
}

LinearBlocks Discretisation::linearise(double weight, Tangent tangent) {
  const Stage stage(exchange_.profile(), "linearisation");
  const int n = local_.element_count();
  if (tangent == Tangent::secant) {
#pragma omp parallel for schedule(static)
    for (int e = 0; e < n; ++e) match_last_change(static_cast<std::size_t>(e));
  }
  linearised_x_ = x_;
  linearised_stress_ = stress_;
  LinearBlocks blocks;
  blocks.x = x_.data();
  blocks.stress = stress_.data();
  blocks.tangent = tangent_.data();
  blocks.mean_stress = mean_stress_.data();
  if (!mixed_) {
    blocks.bulk = bulk_;
    return blocks;
  }
#pragma omp parallel for schedule(static)
  for (int e = 0; e < n; ++e) linearise_element(static_cast<std::size_t>(e), weight);
  blocks.kappa = kappa_;
  blocks.reference = reference_.data();
  blocks.departure = departure_.data();
  blocks.scale = scale_.data();
  blocks.C = C_.data();
  blocks.W = W_.data();
  blocks.schur = schur_.data();
  return blocks;
}

void Discretisation::apply_tangent(const std::vector<int>& elements, const std::vector<double>& u,
                                   const std::vector<double>& p, std::vector<double>& forces,
                                   std::vector<double>& volumes) const {
  std::fill(forces.begin(), forces.end(), 0.0);
  std::fill(volumes.begin(), volumes.end(), 0.0);
  for (int element : elements) {
    const auto e = static_cast<std::size_t>(element);
    ElementGeometry geometry;
    ElementMatrix matrix;
    ElementForces b;
    geometry_of(e, geometry);
    element_tangent(geometry, &stress_[6 * e * slots_], &tangent_[54 * e * slots_],
                    &mean_stress_[e * slots_], mixed_ ? 0 : bulk_, matrix);
    if (mixed_) add_resistance_tangent(resistance(e, geometry), geometry, matrix);
    element_volume_gradient(geometry, b);
    const auto& nodes = local_.elements[e];
    for (int a = 0; a < element_nodes; ++a)
      for (int i = 0; i < 3; ++i) {
        double force = mixed_ ? b[a][i] * p[e] : 0;
        for (int c = 0; c < element_nodes; ++c)
          for (int k = 0; k < 3; ++k)
            force += matrix[a][i][c][k] * u[3 * static_cast<std::size_t>(nodes[c]) + k];
        forces[3 * static_cast<std::size_t>(nodes[a]) + i] += force;
        volumes[e] += b[a][i] * u[3 * static_cast<std::size_t>(nodes[a]) + i];
      }
  }
  exchange_.add_ghosts(forces, 3);
}

void Discretisation::accept(const std::vector<double>& x, const std::vector<double>& p,
                            Configuration& configuration) const {
  configuration.x = x;
  configuration.p = p;
  configuration.state = state_;
  configuration.volume_ratio = volume_ratio_;
}

std::vector<double> Discretisation::cauchy_stress() const {
  const double half_sqrt2 = std::sqrt(0.5);
  std::vector<double> out;
  out.reserve(local_.elements.size() * static_cast<std::size_t>(rule_.points) * 6);
  for (std::size_t e = 0; e < local_.elements.size(); ++e)
    for (int q = 0; q < rule_.points; ++q)
      for (int c = 0; c < 6; ++c) {
        const double s = stress_[6 * slots_ * e + static_cast<std::size_t>(PointRule::at(6, c, q))];
        out.push_back(c < 3 ? s + mean_stress_[slots_ * e + static_cast<std::size_t>(q)]
                            : half_sqrt2 * s);
      }
  return out;
}

std::vector<double> Discretisation::element_stress() const {
  const auto points = cauchy_stress();
  const auto count = static_cast<std::size_t>(rule_.points);
  std::vector<double> out(local_.elements.size() * 6, 0);
  for (std::size_t e = 0; e < local_.elements.size(); ++e) {
    ElementGeometry geometry;
    geometry_of(e, geometry);
    for (std::size_t q = 0; q < count; ++q)
      for (std::size_t c = 0; c < 6; ++c)
        out[6 * e + c] += geometry.weights[q] / geometry.volume * points[(count * e + q) * 6 + c];
  }
  return out;
}

std::array<double, 6> Discretisation::mean_stress() const {
  std::array<double, 7> sums{};
  const auto stress = element_stress();
  for (std::size_t e = 0; e < local_.elements.size(); ++e) {
    for (std::size_t c = 0; c < 6; ++c) sums[c] += volumes_[e] * stress[6 * e + c];
    sums[6] += volumes_[e];
  }
  sum(local_.comm, sums.data(), 7);
  std::array<double, 6> mean{};
  for (std::size_t c = 0; c < 6; ++c) mean[c] = sums[c] / sums[6];
  return mean;
}

double Discretisation::min_jacobian_ratio() const {
  double smallest = 1;
  for (double r : jacobian_ratios_) smallest = std::min(smallest, r);
  return minimum(local_.comm, smallest);
}

}  // namespace polyslip::solver
