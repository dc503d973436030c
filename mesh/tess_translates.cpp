#include "mesh/tess_translates.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace polyslip::mesh {

namespace {

using core::Vec3;
using Rows = std::vector<TessContent::Translate>;

/// Rows whose primaries are no secondaries, sorted; a fault if that cannot be had.
std::string resolve(const char* things, int count, Rows& rows) {
  std::vector<int> row_of(count, -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (row_of[rows[i].secondary] >= 0)
      return fmt::format("{} {} is a secondary twice", things, rows[i].secondary + 1);
    row_of[rows[i].secondary] = static_cast<int>(i);
  }
  for (auto& row : rows)
    for (std::size_t steps = 0; row_of[row.primary] >= 0; ++steps) {
      if (steps == rows.size())
        return fmt::format("{} {} is its own primary", things, row.secondary + 1);
      const auto& next = rows[row_of[row.primary]];
      row.shift = row.shift + next.shift;
      row.orientation *= next.orientation;
      row.primary = next.primary;
    }
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.secondary < b.secondary; });
  return {};
}

std::vector<PeriodicPair> pairs_of(const Rows& rows) {
  std::vector<PeriodicPair> pairs;
  for (const auto& row : rows) pairs.push_back({row.secondary, row.primary, row.shift});
  return pairs;
}

class Joining {
 public:
  Joining(const TessContent::Translates& translates, double distance, Tessellation& tessellation)
      : rows_(translates), distance_(distance), t_(tessellation) {}

  std::string run() {
    auto& topology = t_.topology;
    for (const std::string& fault :
         {resolve("vertex", topology.vertex_count, rows_.vertices),
          resolve("edge", static_cast<int>(topology.edges.size()), rows_.edges),
          resolve("face", static_cast<int>(topology.faces.size()), rows_.faces)})
      if (!fault.empty()) return fault;
    topology.periodic = {pairs_of(rows_.vertices), pairs_of(rows_.edges), pairs_of(rows_.faces)};
    if (std::string fault = place_vertices(); !fault.empty()) return fault;
    turn_edges();
    return turn_faces();
  }

 private:
  std::string place_vertices() {
    for (const auto& pair : t_.topology.periodic.vertices) {
      const Vec3 place = translated(t_.vertices[pair.master], pair.shift, t_.size);
      const double off = (t_.vertices[pair.slave] - place).norm();
      if (!(off <= distance_))
        return fmt::format("vertex {} is {:.3g} off its place beside vertex {}", pair.slave + 1,
                           off, pair.master + 1);
      t_.vertices[pair.slave] = place;
    }
    return {};
  }

  /// A secondary edge that runs against its primary is turned in all its faces.
  void turn_edges() {
    std::vector<char> turned(t_.topology.edges.size(), false);
    for (const auto& row : rows_.edges) {
      if (row.orientation > 0) continue;
      turned[row.secondary] = true;
      auto& ends = t_.topology.edges[row.secondary].vertices;
      std::swap(ends[0], ends[1]);
    }
    for (auto& face : t_.topology.faces)
      for (std::size_t i = 0; i < face.edges.size(); ++i)
        if (turned[face.edges[i]]) face.forward[i] = !face.forward[i];
  }

  /// Primary of a vertex and where that is from there.
  std::pair<int, Shift> primary_of(int vertex) const {
    const auto& rows = rows_.vertices;
    const auto found = std::lower_bound(rows.begin(), rows.end(), vertex,
                                        [](const auto& row, int v) { return row.secondary < v; });
    if (found == rows.end() || found->secondary != vertex) return {vertex, Shift{0, 0, 0}};
    return {found->primary, found->shift};
  }

  std::string turn_faces() {
    for (const auto& pair : t_.topology.periodic.faces) {
      auto [vertex, shift] = primary_of(t_.topology.face_vertices(pair.master).front());
      const auto first = std::pair(vertex, shift + pair.shift);
      const auto loop = t_.topology.face_vertices(pair.slave);
      const auto found =
          std::find_if(loop.begin(), loop.end(), [&](int v) { return primary_of(v) == first; });
      if (found == loop.end())
        return fmt::format("face {} has no vertex where its primary, face {}, has its first",
                           pair.slave + 1, pair.master + 1);
      turn_face(pair, static_cast<int>(found - loop.begin()));
    }
    return {};
  }

  void turn_face(const PeriodicPair& pair, int by) {
    auto& face = t_.topology.faces[pair.slave];
    const int n = static_cast<int>(face.edges.size());
    std::rotate(face.edges.begin(), face.edges.begin() + by, face.edges.end());
    std::rotate(face.forward.begin(), face.forward.begin() + by, face.forward.end());
    const int master = t_.face_masters[pair.master];
    t_.face_masters[pair.slave] = master < 0 ? -1 : (n - master) % n;
  }

  TessContent::Translates rows_;
  double distance_;
  Tessellation& t_;
};

}  // namespace

std::string join_translates(const TessContent::Translates& translates, double distance,
                            Tessellation& tessellation) {
  return Joining(translates, distance, tessellation).run();
}

}  // namespace polyslip::mesh
