#include "solver/flat_faces.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

/// Of all nodes along an axis. Collective.
Extent extent(const LocalMesh& local, const std::vector<double>& x, std::size_t axis) {
  Extent e;
  for (std::size_t i = axis; i < x.size(); i += 3) {
    e.low = std::min(e.low, x[i]);
    e.high = std::max(e.high, x[i]);
  }
  return {minimum(local.comm, e.low), maximum(local.comm, e.high)};
}

/// Farthest outside `plane` of the nodes here that are not on the face; 0 if none is.
double farthest(const LocalMesh& local, const std::vector<double>& x, int face, double plane) {
  const auto axis = static_cast<std::size_t>(face / 2);
  const double outward = face % 2 == 0 ? -1 : 1;
  double distance = 0;
  for (std::size_t n = 0; n < x.size() / 3; ++n)
    if (((local.node_faces[n] >> face) & 1u) == 0)
      distance = std::max(distance, outward * (x[3 * n + axis] - plane));
  return distance;
}

}  // namespace

FlowPast farthest_past_flat_faces(const LocalMesh& local, const Boundary& boundary,
                                  const std::vector<double>& x, double strain) {
  FlowPast worst;
  if (boundary.all) return worst;
  for (const FaceMotion& m : boundary.faces) {
    if (m.relative || m.component != m.face / 2) continue;
    const double distance = maximum(local.comm, farthest(local, x, m.face, m.position(strain)));
    if (distance == 0) continue;
    const Extent body = extent(local, x, static_cast<std::size_t>(m.component));
    const double share = distance / (body.high - body.low);
    if (share > worst.distance) worst = {m.face, share};
  }
  return worst;
}

}  // namespace polyslip::solver
