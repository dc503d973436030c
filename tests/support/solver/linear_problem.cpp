#include "support/solver/linear_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/exchange.hpp"
#include "solver/point_volumes.hpp"

namespace polyslip::test {
namespace {

using core::Mat3;
using core::Vec3;
using solver::check;
using Mat6 = Eigen::Matrix<double, 6, 6>;

double uniform(std::uint64_t& state) {  // SplitMix64
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

Eigen::Matrix<double, 6, 1> mandel(const Mat3& s) {
  const double r = std::sqrt(2.0);
  Eigen::Matrix<double, 6, 1> v;
  v << s(0, 0), s(1, 1), s(2, 2), r * s(1, 2), r * s(2, 0), r * s(0, 1);
  return v;
}

Mat6 deviatoric_projector() {
  Mat6 p = Mat6::Identity();
  p.topLeftCorner<3, 3>().array() -= 1.0 / 3;
  return p;
}

/// Tangent of a grain: elastic compliance plus that of twelve slip systems of very unequal
/// activity, plus a skew part. Eigenvalues about softest ... stiffest; mu: half their harmonic
/// mean.
struct GrainTangent {
  Mat6 tangent = Mat6::Zero();
  double mu = 0;
};

GrainTangent grain_tangent(const LinearProblemOptions& o, std::uint64_t& state) {
  Eigen::Quaterniond q(uniform(state) - 0.5, uniform(state) - 0.5, uniform(state) - 0.5,
                       uniform(state) - 0.5);
  const Mat3 turn = q.normalized().toRotationMatrix();
  Mat6 compliance = Mat6::Zero();
  for (int plane = 0; plane < 4; ++plane) {
    const Vec3 n = Vec3(1, plane & 1 ? -1 : 1, plane & 2 ? -1 : 1) / std::sqrt(3.0);
    for (int k = 0; k < 3; ++k) {
      Vec3 b = Vec3::Zero();
      b[(k + 1) % 3] = n[(k + 2) % 3];
      b[(k + 2) % 3] = -n[(k + 1) % 3];
      const Mat3 schmid = turn * (b.normalized() * n.transpose()) * turn.transpose();
      const auto p = mandel(0.5 * (schmid + schmid.transpose()));
      compliance += std::pow(uniform(state), 8) * (p * p.transpose());
    }
  }
  const double top = Eigen::SelfAdjointEigenSolver<Mat6>(compliance).eigenvalues().maxCoeff();
  const Mat6 dev = deviatoric_projector();
  compliance = compliance / (top * o.softest) + dev / o.stiffest;
  GrainTangent grain;
  const auto eigenvalues = Eigen::SelfAdjointEigenSolver<Mat6>(compliance).eigenvalues();
  grain.mu = 0.5 * std::pow(eigenvalues.tail<5>().prod(), -0.2);
  // Inverse on deviators: the hydrostatic direction is filled in, then taken out.
  const Mat6 hydrostatic = Mat6::Identity() - dev;
  grain.tangent = (compliance + hydrostatic).inverse() - hydrostatic;
  Mat6 skew;
  for (int i = 0; i < 36; ++i) skew(i / 6, i % 6) = uniform(state) - 0.5;
  skew = dev * (skew - skew.transpose()).eval() * dev;
  grain.tangent += o.skew * 2 * grain.mu * skew;
  return grain;
}

/// The lattice of half cells; the six tetrahedra around a cell's diagonal (Kuhn).
class Cube {
 public:
  explicit Cube(const LinearProblemOptions& o) : cells_(o.cells), side_(2 * o.cells + 1) {
    std::array<int, 3> order{0, 1, 2};
    std::vector<std::array<int, 3>> paths;
    do paths.push_back(order);
    while (std::next_permutation(order.begin(), order.end()));
    for (int z = 0; z < cells_; ++z)
      for (int y = 0; y < cells_; ++y)
        for (int x = 0; x < cells_; ++x) {
          const auto slab = [&](int c) { return std::min(o.grains - 1, c * o.grains / cells_); };
          for (const auto& path : paths) {
            add({2 * x, 2 * y, 2 * z}, path);
            mesh_.tetrahedron_cell.push_back(slab(x) + o.grains * (slab(y) + o.grains * slab(z)));
          }
        }
    for (int n = 0; n < side_ * side_ * side_; ++n) mesh_.nodes.push_back(position(n));
  }
  const mesh::Mesh& mesh() const { return mesh_; }
  Vec3 position(int node) const {
    return Vec3(node % side_, node / side_ % side_, node / side_ / side_) / (side_ - 1);
  }

 private:
  int node(const std::array<int, 3>& l) const { return l[0] + side_ * (l[1] + side_ * l[2]); }
  void add(std::array<int, 3> corner, const std::array<int, 3>& path) {
    std::array<std::array<int, 3>, 4> c{};
    for (int i = 0; i < 4; ++i) {
      c[i] = corner;
      if (i < 3) corner[path[i]] += 2;
    }
    const bool even = (path[1] - path[0] + 3) % 3 == 1;
    if (!even) std::swap(c[2], c[3]);
    std::array<int, 10> e{};
    for (int i = 0; i < 4; ++i) e[i] = node(c[i]);
    for (int m = 0; m < 6; ++m) {
      const auto [a, b] = mesh::tetrahedron_edges[m];
      e[4 + m] = node({(c[a][0] + c[b][0]) / 2, (c[a][1] + c[b][1]) / 2, (c[a][2] + c[b][2]) / 2});
    }
    mesh_.tetrahedra.push_back(e);
  }

  int cells_, side_;
  mesh::Mesh mesh_;
};

solver::VecHandle create_vector(MPI_Comm comm, std::size_t size) {
  solver::VecHandle v;
  check(VecCreateMPI(comm, static_cast<PetscInt>(size), PETSC_DETERMINE, v.out()));
  check(VecSet(v.get(), 0));
  return v;
}

std::vector<double> to_vector(Vec v) {
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  check(VecGetLocalSize(v, &n));
  check(VecGetArrayRead(v, &values));
  std::vector<double> out(values, values + n);
  check(VecRestoreArrayRead(v, &values));
  return out;
}

void to_petsc(const std::vector<double>& from, Vec v) {
  PetscInt n = 0;
  PetscScalar* values = nullptr;
  check(VecGetLocalSize(v, &n));
  check(VecGetArrayWrite(v, &values));
  std::copy_n(from.begin(), n, values);
  check(VecRestoreArrayWrite(v, &values));
}

bool fixed(const double* x, int dof) { return x[dof] < 1e-9 || (dof > 0 && x[dof] > 1 - 1e-9); }

const solver::PointRule& rule_of(const LinearProblem& p) { return *p.layout.rule; }

/// Stress and tangent of element e's points, and of the lanes that fill its last block; numbers
/// that depend on the mesh's element alone.
void set_points(LinearProblem& p, std::size_t e, std::uint64_t random, const Mat6& tangent,
                const LinearProblemOptions& o) {
  const auto slots = static_cast<std::size_t>(rule_of(p).slots);
  for (int q = 0; q < rule_of(p).slots; ++q) {
    const auto at = [&](int components, int c) {
      return static_cast<std::size_t>(components) * slots * e +
             static_cast<std::size_t>(solver::PointRule::at(components, c, q));
    };
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          Mat3 h = Mat3::Zero();
          h(k, l) = 1;
          p.tangent[at(54, 9 * i + 3 * k + l)] =
              tangent.row(i).dot(mandel(0.5 * (h + h.transpose())));
        }
    double trace = 0;
    for (int i = 0; i < 6; ++i) {
      double& s = p.stress[at(6, i)];
      s = o.stress * (uniform(random) - 0.5);
      if (i < 3) trace += s;
    }
    for (int i = 0; i < 3; ++i) p.stress[at(6, i)] -= trace / 3;
    p.mean_stress[at(1, 0)] = o.stress * (uniform(random) - 0.5);
  }
}

solver::ElementGeometry geometry_of(const LinearProblem& p, int e) {
  solver::ElementPositions at;
  for (int a = 0; a < 10; ++a)
    for (int i = 0; i < 3; ++i) at[a][i] = p.x[3 * p.mesh->local().elements[e][a] + i];
  solver::ElementGeometry g;
  solver::element_geometry(rule_of(p), at, g);
  return g;
}

void set_scalars(LinearProblem& p, int e, double mu, std::uint64_t random,
                 const LinearProblemOptions& o) {
  const auto g = geometry_of(p, e);
  const auto slots = rule_of(p).slots;
  std::array<double, solver::max_element_points> ratio{};
  for (int q = 0; q < o.points; ++q) ratio[q] = 1 + 0.1 * (uniform(random) - 0.5);
  const auto r = solver::point_volume_resistance(g, ratio.data(), p.kappa);
  for (int q = 0; q < slots; ++q) {
    p.reference[slots * e + q] = r.reference[q];
    p.departure[slots * e + q] = r.s[q];
  }
  solver::ElementForces b;
  solver::element_volume_gradient(g, b);
  double squares = 0;
  for (const auto& node : b)
    for (double c : node) squares += c * c;
  const double V = g.volume, w = std::min(o.weight * mu, p.bulk) / V;
  const double D = w * std::sqrt(squares), C = V / p.bulk;
  p.scale[e] = D;
  p.C[e] = D * D * C;
  p.W[e] = w / D / D;
  p.schur[e] = D * D * (C + (1 - w * C) / (mu / V + w));
}

}  // namespace

LinearProblem make_linear_problem(MPI_Comm comm, const LinearProblemOptions& o) {
  return make_linear_problem(comm, o, Cube(o).mesh());
}

LinearProblem make_linear_problem(MPI_Comm comm, const LinearProblemOptions& o,
                                  const mesh::Mesh& cube) {
  const int ranks = solver::size_of(comm), busy = std::max(1, ranks - o.idle_ranks);
  LinearProblem p;
  p.mesh =
      std::make_unique<solver::Distribution>(comm, cube, solver::partition_elements(cube, busy));
  const solver::LocalMesh& local = p.mesh->local();
  p.exchange = std::make_unique<solver::NodeExchange>(local);
  p.layout.local = &local;
  p.layout.exchange = p.exchange.get();
  p.layout.mixed = o.mixed;
  p.layout.rule = &solver::point_rule(o.points, o.straight);
  std::vector<double> lift;
  for (int n : local.node_mesh) {
    const Vec3& x = cube.nodes[n];
    p.x.insert(p.x.end(), x.data(), x.data() + 3);
    for (int a = 0; a < 3; ++a) p.layout.constrained.push_back(fixed(x.data(), a));
    lift.insert(lift.end(), {0, 0, x[2] > 1 - 1e-9 ? -0.01 : 0});
  }
  p.layout.coordinates.assign(p.x.begin(), p.x.begin() + 3 * local.owned_nodes);

  std::vector<GrainTangent> grains(
      1 + *std::max_element(cube.tetrahedron_cell.begin(), cube.tetrahedron_cell.end()));
  std::uint64_t state = o.seed;
  double mean_mu = 0;
  for (auto& grain : grains) {
    grain = grain_tangent(o, state);
    mean_mu += grain.mu / static_cast<double>(grains.size());
  }
  p.bulk = o.bulk_to_shear * mean_mu;
  p.kappa = o.resistance * mean_mu;
  const std::size_t n = local.elements.size();
  const std::size_t slots = n * static_cast<std::size_t>(rule_of(p).slots);
  p.stress.resize(6 * slots);
  p.tangent.resize(54 * slots);
  for (auto* v : {&p.mean_stress, &p.reference, &p.departure}) v->resize(slots);
  for (auto* v : {&p.scale, &p.C, &p.W, &p.schur}) v->resize(n);
  for (std::size_t e = 0; e < n; ++e) {
    const int number = local.element_mesh[e];
    const GrainTangent& grain = grains[cube.tetrahedron_cell[number]];
    std::uint64_t own = o.seed + 1000003u * static_cast<std::uint64_t>(number);
    const double factor = std::exp(0.6 * (uniform(own) - 0.5));
    set_points(p, e, own, factor * grain.tangent, o);
    set_scalars(p, static_cast<int>(e), factor * grain.mu, own + 1, o);
  }
  p.ru = create_vector(comm, p.layout.displacements());
  p.du = create_vector(comm, p.layout.displacements());
  p.rp = create_vector(comm, p.layout.pressures());
  p.dp = create_vector(comm, p.layout.pressures());
  std::vector<double> fu, fp;
  p.apply_plain(lift, std::vector<double>(n, 0), fu, fp);
  for (double& f : fu) f = -f;
  for (double& f : fp) f = -f;
  to_petsc(fu, p.ru.get());
  if (o.mixed) to_petsc(fp, p.rp.get());
  return p;
}

solver::LinearBlocks LinearProblem::blocks() const {
  solver::LinearBlocks b;
  b.x = x.data();
  b.stress = stress.data();
  b.tangent = tangent.data();
  b.mean_stress = mean_stress.data();
  if (!layout.mixed) {
    b.bulk = bulk;
    return b;
  }
  b.kappa = kappa;
  b.reference = reference.data();
  b.departure = departure.data();
  b.scale = scale.data();
  b.C = C.data();
  b.W = W.data();
  b.schur = schur.data();
  return b;
}

void LinearProblem::element(int e, solver::ElementMatrix& matrix, solver::ElementForces& b) const {
  const auto g = geometry_of(*this, e);
  const int slots = rule_of(*this).slots;
  solver::element_tangent(g, &stress[6 * slots * e], &tangent[54 * slots * e],
                          &mean_stress[slots * e], layout.mixed ? 0 : bulk, matrix);
  solver::element_volume_gradient(g, b);
  if (!layout.mixed || kappa == 0) return;
  solver::PointVolumeResistance r;
  r.kappa = kappa;
  std::copy_n(&reference[slots * e], slots, r.reference.begin());
  std::copy_n(&departure[slots * e], slots, r.s.begin());
  for (int q = 0; q < slots; ++q) r.sum += r.reference[q] * r.s[q];
  solver::add_resistance_tangent(r, g, matrix);
}

void LinearProblem::apply_plain(const std::vector<double>& u, const std::vector<double>& p,
                                std::vector<double>& yu, std::vector<double>& yp) const {
  const solver::LocalMesh& local = mesh->local();
  yu.assign(u.size(), 0);
  yp.assign(local.elements.size(), 0);
  for (int e = 0; e < local.element_count(); ++e) {
    solver::ElementMatrix matrix;
    solver::ElementForces b;
    element(e, matrix, b);
    const auto& nodes = local.elements[e];
    for (int a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i) {
        double& y = yu[3 * nodes[a] + i];
        for (int c = 0; c < 10; ++c)
          for (int k = 0; k < 3; ++k) y += matrix[a][i][c][k] * u[3 * nodes[c] + k];
        if (!layout.mixed) continue;
        y += scale[e] * b[a][i] * p[e];
        yp[e] += scale[e] * b[a][i] * u[3 * nodes[a] + i];
      }
    yp[e] -= layout.mixed ? C[e] * p[e] : 0;
  }
  exchange->add_ghosts(yu, 3);
  for (std::size_t i = 0; i < yu.size(); ++i)
    if (layout.constrained[i]) yu[i] = 0;
}

double LinearProblem::relative_residual() const {
  std::vector<double> u = to_vector(du.get()), p = to_vector(dp.get()), yu, yp;
  const std::vector<double> fu = to_vector(ru.get()), fp = to_vector(rp.get());
  u.resize(x.size());
  exchange->update_ghosts(u, 3);
  if (!layout.mixed) p.assign(mesh->local().elements.size(), 0);
  apply_plain(u, p, yu, yp);
  std::array<double, 4> s{};
  for (std::size_t i = 0; i < fu.size(); ++i) {
    s[0] += (fu[i] - yu[i]) * (fu[i] - yu[i]);
    s[1] += fu[i] * fu[i];
  }
  for (std::size_t e = 0; e < fp.size(); ++e) {
    s[2] += (fp[e] - yp[e]) * (fp[e] - yp[e]);
    s[3] += fp[e] * fp[e];
  }
  solver::sum(mesh->local().comm, s.data(), 4);
  const double worst = std::sqrt(s[0] / s[1]);
  if (!layout.mixed) return worst;
  const double other = std::sqrt(s[2] / s[3]);
  return other > worst || other != other ? other : worst;
}

std::vector<double> LinearProblem::solution() const {
  std::vector<double> u = to_vector(du.get());
  u.resize(x.size());
  std::vector<double> all = mesh->gather_nodes(u, 3);
  if (layout.mixed) {
    const auto p = mesh->gather_elements(to_vector(dp.get()), 1);
    all.insert(all.end(), p.begin(), p.end());
  }
  const MPI_Comm comm = mesh->local().comm;
  all.resize(solver::broadcast(comm, all.size()));
  MPI_Bcast(all.data(), static_cast<int>(all.size()), MPI_DOUBLE, 0, comm);
  return all;
}

}  // namespace polyslip::test
