#include "solver/reactions.hpp"

#include <algorithm>
#include <cmath>

#include "solver/exchange.hpp"

namespace polyslip::solver {

FaceForces face_forces(const LocalMesh& local, const Boundary& boundary,
                       const std::vector<double>& forces) {
  FaceForces out{};
  for (int n = 0; n < local.owned_nodes; ++n)
    for (int i = 0; i < 3; ++i) {
      const std::uint8_t faces = local.node_faces[n];
      const bool prescribed = boundary.constrains(faces, i);
      for (int f = 0; f < 6; ++f) {
        if (((faces >> f) & 1u) == 0 || (prescribed && !boundary.face_constrains(f, i))) continue;
        out[f][i] += forces[3 * static_cast<std::size_t>(n) + i];
      }
    }
  sum(local.comm, &out[0][0], 18);
  return out;
}

Balance balance(const LocalMesh& local, const Boundary& boundary,
                const std::vector<std::uint8_t>& constrained, const std::vector<double>& forces,
                const std::vector<double>& x, const std::vector<double>& volumes,
                const std::vector<double>& volume_gap) {
  Balance b;
  std::array<double, 12> s{};  // free^2, reaction^2, resultant, moment, V gap^2, V, dofs
  for (int n = 0; n < local.owned_nodes; ++n)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t dof = 3 * static_cast<std::size_t>(n) + i;
      const double r = forces[dof];
      s[constrained[dof] ? 1 : 0] += r * r;
      s[constrained[dof] ? 11 : 10] += 1;
      if (constrained[dof]) continue;
      s[2 + i] += r;
      s[5 + i] += x[dof] * r;
    }
  for (std::size_t e = 0; e < volumes.size(); ++e) {
    s[8] += volumes[e] * volume_gap[e] * volume_gap[e];
    s[9] += volumes[e];
  }
  sum(local.comm, s.data(), 12);
  b.free_norm = std::sqrt(s[0]);
  b.reaction_norm = std::sqrt(s[1]);
  b.free_dofs = s[10];
  b.reaction_dofs = s[11];
  b.resultant = {s[2], s[3], s[4]};
  b.moment = {s[5], s[6], s[7]};
  b.volume_gap = std::sqrt(s[8] / s[9]);
  for (const auto& face : face_forces(local, boundary, forces))
    for (double f : face) b.largest_face_force = std::max(b.largest_face_force, std::abs(f));
  return b;
}

std::vector<std::uint8_t> constrained_dofs(const LocalMesh& local, const Boundary& boundary) {
  std::vector<std::uint8_t> out(3 * static_cast<std::size_t>(local.local_nodes), 0);
  for (int n = 0; n < local.local_nodes; ++n)
    for (int i = 0; i < 3; ++i)
      out[3 * static_cast<std::size_t>(n) + i] = boundary.constrains(local.node_faces[n], i);
  return out;
}

}  // namespace polyslip::solver
