#pragma once
// A snapshot of two grains with every field, and small helpers for files.

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "mesh/snapshot.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::tests {

using core::Vec3;

/// Two grains side by side in x, each a cube of m^3 cubes of six tetrahedra.
inline mesh::Mesh two_grains(int m) { return box_mesh({2 * m, m, m}, {2, 1, 1}, 2); }

/// Numbers without a pattern, the same on every machine.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 42;
};

inline mesh::Field field(const std::string& name, mesh::Location location, int components,
                         const std::string& unit, std::size_t rows, Numbers& numbers,
                         core::Transport transport = core::Transport::element_average) {
  mesh::Field f{name, location, components, unit, transport, "made up " + name, {}};
  for (std::size_t i = 0; i < rows * static_cast<std::size_t>(components); ++i)
    f.values.push_back(numbers.next() - 0.3);
  return f;
}

/// A snapshot of a mesh bent and compressed to `strain`, with all fields filled.
inline mesh::Snapshot fabricated_snapshot(int m, double strain, int mesh_number = 0) {
  using mesh::Location;
  mesh::Snapshot s;
  s.mesh = two_grains(m);
  s.mesh_number = mesh_number;
  s.strain = strain;
  s.time = strain;
  Numbers numbers;
  const auto first = s.mesh.nodes;
  for (auto& x : s.mesh.nodes) {
    const double bend = 0.2 * strain * std::sin(3 * x[0]) * x[2];
    x = Vec3(x[0] * std::exp(strain) + bend, x[1], x[2] * std::exp(-strain));
  }
  const std::size_t nodes = s.mesh.nodes.size(), elements = s.mesh.tetrahedra.size();
  auto displacement = field("displacement", Location::node, 3, "L", nodes, numbers,
                            core::Transport::shape_functions);
  for (std::size_t i = 0; i < nodes; ++i)
    for (int c = 0; c < 3; ++c) displacement.values[3 * i + c] = s.mesh.nodes[i][c] - first[i][c];
  s.fields.push_back(displacement);
  auto orientation = field("orientation", Location::quadrature_point, 4, "1", 4 * elements, numbers,
                           core::Transport::orientation_average);
  for (std::size_t p = 0; p < 4 * elements; ++p) {
    const bool second = s.mesh.tetrahedron_cell[p / 4] == 1;
    core::Quaternion q(second ? 0.3 : 0.9, second ? 0.8 : -0.1, 0.2 + 0.05 * numbers.next(), 0.1);
    q.normalize();
    double* v = &orientation.values[4 * p];
    v[0] = q.w(), v[1] = q.x(), v[2] = q.y(), v[3] = q.z();
  }
  s.fields.push_back(orientation);
  for (const char* name : {"g", "slip", "equivalent_strain"})
    s.fields.push_back(field(name, Location::quadrature_point, 1, "1", 4 * elements, numbers));
  s.fields.push_back(field("cauchy_stress", Location::quadrature_point, 6, "MPa", 4 * elements,
                           numbers, core::Transport::reset_to_zero));
  s.fields.push_back(field("cauchy_stress", Location::element, 6, "MPa", elements, numbers,
                           core::Transport::reset_to_zero));
  s.fields.push_back(field("pressure", Location::element, 1, "MPa", elements, numbers));
  s.history["step_size"] = {1e-3, std::nextafter(0.1, 1.0)};
  s.history["nothing"] = {};
  s.provenance = {{"version", "0.1.0"}, {"deck_hash", "abc"}, {"empty", ""}};
  return s;
}

/// An empty folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "polyslip-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void spit(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace polyslip::tests
