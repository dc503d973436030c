#include "solver/planar_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/shape_functions.hpp"
#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

/// Corner nodes of the faces of a tetrahedron.
constexpr int tetrahedron_faces[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};

/// Mid node of the edge between two corners.
int mid_node(int a, int b) {
  const auto joins = [&](int e) {
    const auto [i, j] = mesh::tetrahedron_edges[static_cast<std::size_t>(e)];
    return (i == a && j == b) || (i == b && j == a);
  };
  int e = 0;
  while (e < 5 && !joins(e)) ++e;
  return 4 + e;
}

/// Area of a six-node triangle projected along `axis`, exact (three-point rule, degree 2).
double projected_area(const std::array<int, 6>& nodes, const std::vector<double>& x, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  double area = 0;
  for (int point = 0; point < 3; ++point) {
    std::array<double, 3> l{1.0 / 6, 1.0 / 6, 1.0 / 6};
    l[static_cast<std::size_t>(point)] = 2.0 / 3;
    // d x / d l_c with l_0 = 1 - l_1 - l_2
    double derivative[2][2] = {};
    for (int c = 0; c < 3; ++c) {
      const auto next = static_cast<std::size_t>((c + 1) % 3);
      const auto here = static_cast<std::size_t>(c);
      double by[3] = {};  // of the two shape functions below by l_0 ... l_2
      const auto add = [&](int node, const double* gradient) {
        const double* at = &x[3 * static_cast<std::size_t>(node)];
        for (int d = 0; d < 2; ++d) {
          derivative[0][d] += at[i] * (gradient[d + 1] - gradient[0]);
          derivative[1][d] += at[j] * (gradient[d + 1] - gradient[0]);
        }
      };
      by[here] = 4 * l[here] - 1;
      add(nodes[here], by);
      by[here] = 4 * l[next];
      by[next] = 4 * l[here];
      add(nodes[3 + here], by);
    }
    area += (derivative[0][0] * derivative[1][1] - derivative[0][1] * derivative[1][0]) / 6;
  }
  return std::abs(area);
}

}  // namespace

PlanarFaces::PlanarFaces(const LocalMesh& local, const Boundary& boundary)
    : local_(local), faces_(boundary.planar) {
  const std::size_t n = faces_.size();
  dofs_.resize(n);
  owned_.assign(n, 0);
  triangles_.resize(n);
  is_planar_.assign(3 * static_cast<std::size_t>(local.local_nodes), 0);
  if (boundary.all) faces_.clear();
  for (std::size_t k = 0; k < faces_.size(); ++k)
    for (int node = 0; node < local.local_nodes; ++node) {
      const int c = faces_[k].component();
      if (((local.node_faces[node] >> faces_[k].face) & 1u) == 0 ||
          !boundary.planar_constrains(local.node_faces[node], c))
        continue;
      dofs_[k].push_back(3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(c));
      is_planar_[dofs_[k].back()] = 1;
      if (local.owned(node)) ++owned_[k];
    }
  for (int e = 0; e < local.element_count(); ++e) {
    const auto& nodes = local.elements[e];
    unsigned touched = 0;
    for (int node : nodes) touched |= local.node_faces[node];
    bool near = false;
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      if (((touched >> faces_[k].face) & 1u) == 0) continue;
      near = true;
      for (const auto& c : tetrahedron_faces) {
        const std::array<int, 6> t{nodes[c[0]],
                                   nodes[c[1]],
                                   nodes[c[2]],
                                   nodes[mid_node(c[0], c[1])],
                                   nodes[mid_node(c[1], c[2])],
                                   nodes[mid_node(c[2], c[0])]};
        if (std::all_of(t.begin(), t.end(), [&](int node) {
              return ((local.node_faces[node] >> faces_[k].face) & 1u) != 0;
            }))
          triangles_[k].push_back(t);
      }
    }
    if (near) elements_.push_back(e);
  }
}

std::vector<double> PlanarFaces::direction(std::size_t k) const {
  std::vector<double> v(is_planar_.size(), 0);
  for (std::size_t dof : dofs_[k]) v[dof] = 1;
  return v;
}

std::array<double, 2> PlanarFaces::ends(std::size_t k, const std::vector<double>& x) const {
  const auto c = static_cast<std::size_t>(faces_[k].component());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t dof = c; dof < x.size(); dof += 3) {
    low = std::min(low, x[dof]);
    high = std::max(high, x[dof]);
  }
  low = minimum(local_.comm, low);
  high = maximum(local_.comm, high);
  return faces_[k].outward() > 0 ? std::array{high, low} : std::array{low, high};
}

double PlanarFaces::extent(std::size_t k, const std::vector<double>& x) const {
  const auto [face, far] = ends(k, x);
  return face - far;
}

std::vector<double> PlanarFaces::stretch(std::size_t k, const std::vector<double>& x) const {
  const auto [face, far] = ends(k, x);
  std::vector<double> u(x.size(), 0);
  for (std::size_t dof = static_cast<std::size_t>(faces_[k].component()); dof < x.size(); dof += 3)
    u[dof] = (x[dof] - far) / (face - far);
  for (const std::size_t dof : dofs_[k]) u[dof] = 1;
  return u;
}

std::vector<double> PlanarFaces::sums(const std::vector<double>& values) const {
  std::vector<double> out(count(), 0);
  for (std::size_t k = 0; k < count(); ++k)
    for (std::size_t i = 0; i < owned_[k]; ++i) out[k] += values[dofs_[k][i]];
  if (!out.empty()) sum(local_.comm, out.data(), static_cast<int>(out.size()));
  return out;
}

void PlanarFaces::flatten(std::vector<double>& x) const {
  if (count() == 0) return;
  const auto total = sums(x);
  const auto nodes = sums(std::vector<double>(x.size(), 1));
  for (std::size_t k = 0; k < count(); ++k)
    for (std::size_t dof : dofs_[k]) x[dof] = total[k] / nodes[k];
}

std::vector<double> PlanarFaces::areas(const std::vector<double>& x) const {
  std::vector<double> out(count(), 0);
  for (std::size_t k = 0; k < count(); ++k)
    for (const auto& t : triangles_[k]) out[k] += projected_area(t, x, faces_[k].component());
  if (!out.empty()) sum(local_.comm, out.data(), static_cast<int>(out.size()));
  return out;
}

std::vector<double> PlanarFaces::residuals(const std::vector<double>& forces,
                                           const std::vector<double>& x, double path) const {
  auto out = sums(forces);
  const auto area = areas(x);
  for (std::size_t k = 0; k < count(); ++k)
    out[k] -= faces_[k].outward() * faces_[k].traction(path) * area[k];
  return out;
}

std::vector<double> solve_dense(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

}  // namespace polyslip::solver
