#include "support/solver/linear_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesh/quadrature.hpp"
#include "mesh/shape_functions.hpp"

namespace polyslip::test {
namespace {

using core::Mat3;
using core::Vec3;
using solver::check;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat30 = Eigen::Matrix<double, 30, 30>;
using Vec30 = Eigen::Matrix<double, 30, 1>;

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

struct Element {
  std::array<PetscInt, 10> nodes{};
  int grain = 0;
};

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
            add({2 * x, 2 * y, 2 * z}, path, slab(x) + o.grains * (slab(y) + o.grains * slab(z)));
          }
        }
  }
  PetscInt node_count() const { return side_ * side_ * side_; }
  const std::vector<Element>& elements() const { return elements_; }
  std::array<int, 3> lattice(PetscInt node) const {
    return {static_cast<int>(node % side_), static_cast<int>(node / side_ % side_),
            static_cast<int>(node / side_ / side_)};
  }
  Vec3 position(PetscInt node) const {
    const auto l = lattice(node);
    return Vec3(l[0], l[1], l[2]) / (side_ - 1);
  }
  PetscInt node(const std::array<int, 3>& l) const {
    return l[0] + side_ * (l[1] + PetscInt{side_} * l[2]);
  }
  bool constrained(PetscInt n, int dof) const {
    const auto l = lattice(n);
    return l[dof] == 0 || (dof > 0 && l[dof] == side_ - 1);
  }

 private:
  void add(std::array<int, 3> corner, const std::array<int, 3>& path, int grain) {
    std::array<std::array<int, 3>, 4> c{};
    for (int i = 0; i < 4; ++i) {
      c[i] = corner;
      if (i < 3) corner[path[i]] += 2;
    }
    const bool even = (path[1] - path[0] + 3) % 3 == 1;
    if (!even) std::swap(c[2], c[3]);
    Element e;
    e.grain = grain;
    for (int i = 0; i < 4; ++i) e.nodes[i] = node(c[i]);
    for (int m = 0; m < 6; ++m) {
      const auto [a, b] = mesh::tetrahedron_edges[m];
      e.nodes[4 + m] =
          node({(c[a][0] + c[b][0]) / 2, (c[a][1] + c[b][1]) / 2, (c[a][2] + c[b][2]) / 2});
    }
    elements_.push_back(e);
  }

  int cells_;
  PetscInt side_;
  std::vector<Element> elements_;
};

struct ElementMatrices {
  Mat30 a = Mat30::Zero();
  Vec30 b = Vec30::Zero();
  double volume = 0;
};

ElementMatrices integrate(const Cube& cube, const Element& element, const Mat6& tangent) {
  ElementMatrices m;
  std::array<Vec3, 10> x;
  for (int i = 0; i < 10; ++i) x[i] = cube.position(element.nodes[i]);
  for (const auto& point : mesh::tet_quadrature_4()) {
    const auto local = mesh::tet10_gradients(point.xi);
    const Mat3 j = mesh::tet10_jacobian(x, local);
    const double w = point.weight * j.determinant();
    Eigen::Matrix<double, 6, 30> strain = Eigen::Matrix<double, 6, 30>::Zero();
    for (int i = 0; i < 10; ++i) {
      const Vec3 g = j.transpose().inverse() * local[i];
      for (int a = 0; a < 3; ++a) {
        Mat3 du = Mat3::Zero();
        du.row(a) = g.transpose();
        strain.col(3 * i + a) = mandel(0.5 * (du + du.transpose()));
        m.b[3 * i + a] += w * g[a];
      }
    }
    m.a += w * strain.transpose() * tangent * strain;
    m.volume += w;
  }
  return m;
}

void own_nodes(LinearProblem& p, const Cube& cube, PetscInt first, PetscInt last) {
  auto& layout = p.layout;
  for (PetscInt n = first; n < last; ++n) {
    auto low = cube.lattice(n), high = low;
    bool corner = true;
    for (int a = 0; a < 3; ++a) {
      if (low[a] % 2 == 0) continue;
      corner = false;
      --low[a];
      ++high[a];
    }
    layout.is_corner.push_back(corner);
    layout.parents.push_back({cube.node(low), cube.node(high)});
    const Vec3 x = cube.position(n);
    for (int a = 0; a < 3; ++a) {
      layout.coordinates.push_back(x[a]);
      layout.constrained.push_back(cube.constrained(n, a));
    }
  }
}

std::vector<std::vector<PetscInt>> neighbours(const Cube& cube) {
  std::vector<std::vector<PetscInt>> near(cube.node_count());
  for (const Element& e : cube.elements())
    for (const PetscInt n : e.nodes) near[n].insert(near[n].end(), e.nodes.begin(), e.nodes.end());
  for (auto& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

void create_displacement_matrix(const LinearProblem& p, const Cube& cube, PetscInt first,
                                solver::MatHandle& matrix) {
  const auto near = neighbours(cube);
  const PetscInt n = p.layout.local_nodes;
  std::vector<PetscInt> own(n, 0), other(n, 0);
  for (PetscInt i = 0; i < n; ++i) {
    for (const PetscInt j : near[first + i]) ++(j >= first && j < first + n ? own : other)[i];
  }
  check(MatCreate(p.layout.comm, matrix.out()));
  check(MatSetSizes(matrix.get(), 3 * n, 3 * n, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetBlockSize(matrix.get(), 3));
  check(MatSetType(matrix.get(), MATBAIJ));
  check(MatSeqBAIJSetPreallocation(matrix.get(), 3, 0, own.data()));
  check(MatMPIBAIJSetPreallocation(matrix.get(), 3, 0, own.data(), 0, other.data()));
}

void create_vectors(LinearProblem& p) {
  const PetscInt rows = 3 * p.layout.local_nodes, pressures = p.layout.local_pressures;
  check(VecCreateMPI(p.layout.comm, rows, PETSC_DETERMINE, p.ru.out()));
  check(VecDuplicate(p.ru.get(), p.du.out()));
  check(VecCreateMPI(p.layout.comm, pressures, PETSC_DETERMINE, p.rp.out()));
  for (auto* v : {&p.dp, &p.C, &p.W, &p.schur}) check(VecDuplicate(p.rp.get(), v->out()));
}

void set(Vec v, PetscInt row, double value) {
  check(VecSetValues(v, 1, &row, &value, INSERT_VALUES));
}

/// Adds element number `e` with its Dirichlet rows and columns taken out: the displaced z1 face
/// (by -0.01) goes to the right side.
void add_element(LinearProblem& p, const Cube& cube, PetscInt e, const ElementMatrices& m,
                 double mu, double bulk, const LinearProblemOptions& o) {
  const Element& element = cube.elements()[e];
  const double w = std::min(o.weight * mu, bulk) / m.volume, c = m.volume / bulk;
  Mat30 a = m.a;
  if (!o.mixed) a += m.b * m.b.transpose() / c;
  Vec30 lift = Vec30::Zero(), b = m.b;
  std::array<bool, 30> fixed{};
  for (int i = 0; i < 30; ++i) {
    const PetscInt n = element.nodes[i / 3];
    fixed[i] = cube.constrained(n, i % 3);
    if (i % 3 == 2) lift[i] = fixed[i] ? -0.01 * cube.position(n)[2] : 0.0;
  }
  Vec30 force = -a * lift;
  for (int i = 0; i < 30; ++i) {
    if (!fixed[i]) continue;
    a.row(i).setZero();
    a.col(i).setZero();
    b[i] = force[i] = 0;
  }
  const Mat30 augmented = o.mixed ? Mat30(a + w * b * b.transpose()) : a;
  const auto add = [&](Mat matrix, const Mat30& values) {
    const Eigen::Matrix<double, 30, 30, Eigen::RowMajor> rows = values;
    check(MatSetValuesBlocked(matrix, 10, element.nodes.data(), 10, element.nodes.data(),
                              rows.data(), ADD_VALUES));
  };
  add(p.A.get(), a);
  add(p.A_augmented.get(), augmented);
  std::array<PetscInt, 30> dofs{};
  for (int i = 0; i < 30; ++i) dofs[i] = 3 * element.nodes[i / 3] + i % 3;
  check(VecSetValues(p.ru.get(), 30, dofs.data(), force.data(), ADD_VALUES));
  if (!o.mixed) return;
  check(MatSetValues(p.B.get(), 1, &e, 30, dofs.data(), b.data(), INSERT_VALUES));
  set(p.rp.get(), e, -m.b.dot(lift));
  set(p.C.get(), e, c);
  set(p.W.get(), e, w);
  set(p.schur.get(), e, c + (1 - w * c) / (mu / m.volume + w));
}

void assemble(Mat m) {
  check(MatAssemblyBegin(m, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(m, MAT_FINAL_ASSEMBLY));
}

void assemble(Vec v) {
  check(VecAssemblyBegin(v));
  check(VecAssemblyEnd(v));
}

void add_unit_diagonals(LinearProblem& p) {
  solver::VecHandle unit;
  check(VecDuplicate(p.ru.get(), unit.out()));
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(unit.get(), &values));
  for (std::size_t i = 0; i < p.layout.constrained.size(); ++i) values[i] = p.layout.constrained[i];
  check(VecRestoreArrayWrite(unit.get(), &values));
  for (const Mat m : {p.A.get(), p.A_augmented.get()}) {
    check(MatDiagonalSet(m, unit.get(), ADD_VALUES));
  }
}

}  // namespace

LinearProblem make_linear_problem(MPI_Comm comm, const LinearProblemOptions& o) {
  const Cube cube(o);
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  const int busy = std::max(1, ranks - o.idle_ranks);
  const auto share = [&](PetscInt n, int r) { return n * std::min(r, busy) / busy; };
  const PetscInt first = share(cube.node_count(), rank), last = share(cube.node_count(), rank + 1);
  const auto elements = static_cast<PetscInt>(cube.elements().size());
  const PetscInt first_element = share(elements, rank), last_element = share(elements, rank + 1);

  LinearProblem p;
  p.layout.comm = comm;
  p.layout.local_nodes = last - first;
  p.layout.local_pressures = o.mixed ? last_element - first_element : 0;
  own_nodes(p, cube, first, last);
  create_displacement_matrix(p, cube, first, p.A);
  create_displacement_matrix(p, cube, first, p.A_augmented);
  create_vectors(p);
  if (o.mixed) {
    check(MatCreateAIJ(comm, p.layout.local_pressures, 3 * p.layout.local_nodes, PETSC_DETERMINE,
                       PETSC_DETERMINE, 30, nullptr, 30, nullptr, p.B.out()));
  }
  std::vector<GrainTangent> grains(o.grains * o.grains * o.grains);
  std::uint64_t state = o.seed;
  double mean_mu = 0;
  for (auto& grain : grains) {
    grain = grain_tangent(o, state);
    mean_mu += grain.mu / static_cast<double>(grains.size());
  }
  const double bulk = o.bulk_to_shear * mean_mu;
  for (PetscInt e = first_element; e < last_element; ++e) {
    const Element& element = cube.elements()[e];
    const GrainTangent& grain = grains[element.grain];
    std::uint64_t own = o.seed + 1000003u * static_cast<std::uint64_t>(e);
    const double factor = std::exp(0.6 * (uniform(own) - 0.5));
    add_element(p, cube, e, integrate(cube, element, factor * grain.tangent), factor * grain.mu,
                bulk, o);
  }
  for (const Mat m : {p.A.get(), p.A_augmented.get()}) assemble(m);
  if (o.mixed) assemble(p.B.get());
  for (auto* v : {&p.ru, &p.rp, &p.C, &p.W, &p.schur}) assemble(v->get());
  add_unit_diagonals(p);
  return p;
}

double LinearProblem::relative_residual() const {
  solver::VecHandle r, t, s;
  PetscReal norm = 0, scale = 0;
  check(VecDuplicate(ru.get(), r.out()));
  check(MatMult(A.get(), du.get(), r.get()));
  if (B) check(MatMultTransposeAdd(B.get(), dp.get(), r.get(), r.get()));
  check(VecAXPY(r.get(), -1, ru.get()));
  check(VecNorm(r.get(), NORM_2, &norm));
  check(VecNorm(ru.get(), NORM_2, &scale));
  double worst = norm / scale;
  if (!B) return worst;
  check(VecDuplicate(rp.get(), s.out()));
  check(VecDuplicate(rp.get(), t.out()));
  check(MatMult(B.get(), du.get(), s.get()));
  check(VecPointwiseMult(t.get(), C.get(), dp.get()));
  check(VecAXPY(s.get(), -1, t.get()));
  check(VecAXPY(s.get(), -1, rp.get()));
  check(VecNorm(s.get(), NORM_2, &norm));
  check(VecNorm(rp.get(), NORM_2, &scale));
  return norm / scale > worst || norm != norm ? norm / scale : worst;
}

}  // namespace polyslip::test
