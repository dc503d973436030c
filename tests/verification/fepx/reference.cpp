#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "mesh/quadrature.hpp"
#include "mesh/text_scanner.hpp"

namespace polyslip::tests {
namespace {

using core::Quaternion;
using core::Vec3;
using core::Vec6;

/// The rotation whose matrix has the crystal axes in sample axes as its columns.
Quaternion from_rodrigues(const Vec3& r) { return Quaternion(1, r[0], r[1], r[2]).normalized(); }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    if (text[from] != '#') lines.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

const mesh::Field& field(const mesh::Snapshot& s, const char* name) {
  const auto* f = s.find(name, mesh::Location::quadrature_point);
  if (!f || f->values.empty()) throw core::InternalError(std::string("no field ") + name);
  return *f;
}

/// A field at the centroid of an element.
std::vector<double> at_centroid(const mesh::Snapshot& s, const mesh::Field& f,
                                std::size_t element) {
  const auto rule = mesh::tet_quadrature(s.quadrature_points);
  const auto components = static_cast<std::size_t>(f.components);
  const double* first = &f.values[element * rule.size() * components];
  if (rule.size() == 15) return {first, first + components};
  std::vector<double> sum(components, 0.0);
  for (std::size_t q = 0; q < rule.size(); ++q)
    for (std::size_t c = 0; c < components; ++c)
      sum[c] += 6 * rule[q].weight * first[q * components + c];
  return sum;
}

double von_mises(const Vec6& s) {
  const double p = (s[0] + s[1] + s[2]) / 3;
  const double normal = std::pow(s[0] - p, 2) + std::pow(s[1] - p, 2) + std::pow(s[2] - p, 2);
  return std::sqrt(1.5 * (normal + 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])));
}

double pressure(const Vec6& s) { return -(s[0] + s[1] + s[2]) / 3; }

Vec3 centroid(const mesh::Mesh& mesh, std::size_t element) {
  const auto& nodes = mesh.tetrahedra[element];
  return (mesh.nodes[nodes[0]] + mesh.nodes[nodes[1]] + mesh.nodes[nodes[2]] +
          mesh.nodes[nodes[3]]) /
         4;
}

std::size_t nearest(const std::vector<Vec3>& points, const Vec3& x) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i] - x).norm();
    if (distance < least) least = distance, best = i;
  }
  // The files round to 10^-6; centroids are 10^-2 apart and more.
  if (!(least < 1e-5)) throw core::InternalError("compare: the meshes are not the same");
  return best;
}

}  // namespace

CentroidValues read_reference(const std::string& name) {
  const std::string path = POLYSLIP_SOURCE_DIR "/tests/data/fepx/" + name + ".txt.gz";
  CentroidValues out;
  for (const std::string& line : lines_of(mesh::read_maybe_compressed(path))) {
    mesh::TextScanner text(path, line);
    std::vector<double> v;
    while (!text.peek().empty()) v.push_back(text.number("a number"));
    if (v.size() != 13 && v.size() != 24) throw core::InternalError(path + ": damaged");
    out.centroid.emplace_back(v[0], v[1], v[2]);
    out.orientation.push_back(from_rodrigues({v[3], v[4], v[5]}));
    out.stress.emplace_back(Eigen::Map<const Vec6>(&v[6]));
    out.g.emplace_back(v.begin() + 12, v.end());
  }
  return out;
}

CentroidValues centroid_values(const mesh::Snapshot& state, const mesh::Snapshot& start) {
  CentroidValues out;
  const auto &orientation = field(state, "orientation"), &stress = field(state, "cauchy_stress"),
             &g = field(state, "g");
  for (std::size_t e = 0; e < state.mesh.tetrahedra.size(); ++e) {
    out.centroid.push_back(centroid(start.mesh, e));
    const auto q = at_centroid(state, orientation, e), s = at_centroid(state, stress, e);
    out.orientation.push_back(Quaternion(q[0], q[1], q[2], q[3]).normalized());
    out.stress.emplace_back(Eigen::Map<const Vec6>(s.data()));
    out.g.push_back(at_centroid(state, g, e));
  }
  return out;
}

Differences compare(const CentroidValues& ours, const CentroidValues& reference,
                    const mesh::Snapshot& start) {
  const std::size_t n = reference.centroid.size();
  if (n == 0 || ours.centroid.size() != n)
    throw core::InternalError("compare: the meshes are not the same");
  Differences d;
  d.g.assign(reference.g.front().size(), 0.0);
  double volume = 0, flow = 0;
  for (std::size_t r = 0; r < n; ++r) {
    const std::size_t e = nearest(ours.centroid, reference.centroid[r]);
    const double w = mesh::element_volume(start.mesh, static_cast<int>(e));
    const double angle =
        core::degrees_per_radian *
        core::rotation_angle(ours.orientation[e] * reference.orientation[r].conjugate());
    d.mean_angle += angle / static_cast<double>(n);
    d.largest_angle = std::max(d.largest_angle, angle);
    d.deviator += w * von_mises(ours.stress[e] - reference.stress[r]);
    flow += w * von_mises(reference.stress[r]);
    const double p = pressure(reference.stress[r]);
    d.pressure += w * std::pow(pressure(ours.stress[e]) - p, 2);
    d.reference_pressure += w * p * p;
    volume += w;
    for (std::size_t a = 0; a < d.g.size(); ++a)
      d.g[a] += w * std::abs(ours.g[e].at(a) / reference.g[r][a] - 1);
  }
  d.deviator /= flow;
  for (double& g : d.g) g /= volume;
  d.pressure = std::sqrt(d.pressure / volume);
  d.reference_pressure = std::sqrt(d.reference_pressure / volume);
  return d;
}

}  // namespace polyslip::tests
