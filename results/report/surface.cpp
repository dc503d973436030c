#include "results/report/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.hpp"

namespace polyslip::results::report {
namespace {

using Corners = std::array<int, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

Corners corners_of(const mesh::Mesh& mesh, std::size_t triangle) {
  const auto& nodes = mesh.triangles[triangle];
  return {nodes[0], nodes[1], nodes[2]};
}

/// [triangle][side] element; -1 where there is none.
std::vector<std::array<int, 2>> elements_behind(const mesh::Mesh& mesh) {
  std::vector<std::pair<Corners, std::size_t>> facets;  // in order, to be searched
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    facets.emplace_back(sorted(corners_of(mesh, t)), t);
  std::sort(facets.begin(), facets.end());
  std::vector<std::array<int, 2>> behind(mesh.triangles.size(), {-1, -1});
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& nodes = mesh.tetrahedra[e];
    for (int opposite = 0; opposite < 4; ++opposite) {
      Corners corners{};
      for (int i = 0, k = 0; i < 4; ++i)
        if (i != opposite) corners[k++] = nodes[i];
      corners = sorted(corners);
      const auto found =
          std::lower_bound(facets.begin(), facets.end(), std::pair{corners, std::size_t{0}});
      if (found == facets.end() || found->first != corners) continue;
      const auto& cells = mesh.topology.faces[mesh.triangle_face[found->second]].cells;
      behind[found->second][cells[0] == mesh.tetrahedron_cell[e] ? 0 : 1] = e;
    }
  }
  return behind;
}

std::set<std::pair<int, int>> line_segments(const mesh::Mesh& mesh) {
  std::set<std::pair<int, int>> segments;
  for (const auto& line : mesh.lines) segments.insert(std::minmax(line[0], line[1]));
  return segments;
}

}  // namespace

Surface surface_of(const mesh::Mesh& mesh) {
  Surface s;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int node : corners_of(mesh, t)) s.nodes.push_back(node);
  std::sort(s.nodes.begin(), s.nodes.end());
  s.nodes.erase(std::unique(s.nodes.begin(), s.nodes.end()), s.nodes.end());
  std::vector<std::uint32_t> number(mesh.nodes.size());
  for (std::size_t i = 0; i < s.nodes.size(); ++i)
    number[s.nodes[i]] = static_cast<std::uint32_t>(i);

  const auto segments = line_segments(mesh);
  const auto behind = elements_behind(mesh);
  std::vector<int> second_sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners corners = corners_of(mesh, t);
    const auto& cells = mesh.topology.faces[mesh.triangle_face[t]].cells;
    if (behind[t][0] < 0 || (behind[t][1] < 0) != (cells[1] < 0))
      throw core::InternalError(fmt::format(
          "results/report: triangle {} has elements {} and {} behind it, grains {} and {}", t,
          behind[t][0], behind[t][1], cells[0], cells[1]));
    s.triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
    s.grains.push_back(
        {static_cast<std::uint32_t>(cells[0] + 1), static_cast<std::uint32_t>(cells[1] + 1)});
    std::uint8_t lines = 0;
    for (int i = 0; i < 3; ++i)
      if (segments.contains(std::minmax(corners[i], corners[(i + 1) % 3]))) lines |= 1u << i;
    s.lines.push_back(lines);
    s.elements.push_back(behind[t][0]);
    if (behind[t][1] >= 0) second_sides.push_back(behind[t][1]);
  }
  s.elements.insert(s.elements.end(), second_sides.begin(), second_sides.end());
  return s;
}

}  // namespace polyslip::results::report
