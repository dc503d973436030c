#include "mesh/msh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "mesh/grain_topology.hpp"
#include "mesh/msh_parser.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

class MshReader {
 public:
  MshReader(const std::string& path, LengthUnit unit)
      : path_(path), content_(parse_msh(path)), unit_(unit) {}

  MeshFile read() {
    if (content_.tetrahedra.empty()) fail("there are no tetrahedra");
    result_.mesh.order = content_.order;
    sort_by_grain();
    number_nodes();
    place_in_box();
    give_orientations();
    finish();
    return std::move(result_);
  }

 private:
  using Element = MshContent::Tetrahedron;

  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError(path_ + ": " + what);
  }

  void sort_by_grain() {
    const bool physical = std::any_of(content_.tetrahedra.begin(), content_.tetrahedra.end(),
                                      [](const Element& e) { return e.physical != 0; });
    const auto grain = [&](int i) {
      return physical ? content_.tetrahedra[i].physical : content_.tetrahedra[i].elementary;
    };
    auto& rows = result_.file_rows;
    rows.resize(content_.tetrahedra.size());
    std::iota(rows.begin(), rows.end(), 0);
    std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return grain(a) < grain(b); });
    auto& ids = result_.grain_ids;
    for (const int row : rows) {
      if (grain(row) < 1)
        fail(fmt::format("element {} has no physical volume to tell its grain",
                         content_.tetrahedra[row].number));
      if (ids.empty() || ids.back() != grain(row)) ids.push_back(grain(row));
      result_.mesh.tetrahedron_cell.push_back(static_cast<int>(ids.size()) - 1);
    }
    result_.mesh.topology.cell_faces.resize(ids.size());
  }

  /// Nodes that tetrahedra use get numbers, in the order of the file.
  void number_nodes() {
    Mesh& mesh = result_.mesh;
    std::vector<int> used(content_.positions.size(), -1);
    for (const int row : result_.file_rows) {
      const Element& e = content_.tetrahedra[row];
      std::array<int, 10> nodes;
      for (int i = 0; i < 10; ++i) nodes[i] = i >= 4 && mesh.order == 1 ? -1 : place_of(e, i);
      for (const int n : nodes)
        if (n >= 0) used[n] = 0;
      mesh.tetrahedra.push_back(nodes);
    }
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i] == 0) {
        used[i] = mesh.node_count();
        mesh.nodes.push_back(content_.positions[i]);
      }
    for (auto& t : mesh.tetrahedra)
      for (int& n : t)
        if (n >= 0) n = used[n];
  }

  int place_of(const Element& e, int i) const {
    const auto found = std::lower_bound(content_.node_ids.begin(), content_.node_ids.end(),
                                        std::pair{e.nodes[i], 0});
    if (found == content_.node_ids.end() || found->first != e.nodes[i])
      fail(fmt::format("element {} has node {}, which is not in $Nodes", e.number, e.nodes[i]));
    return found->second;
  }

  void place_in_box() {
    Mesh& mesh = result_.mesh;
    Vec3 low = mesh.nodes[0], high = low;
    for (const Vec3& x : mesh.nodes) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const Vec3 size = high - low;
    if (!(size.minCoeff() > 0)) fail("the box of the nodes has no volume");
    const double ratio = mesh.topology.cell_count() / size.prod();
    const bool keep = unit_ == LengthUnit::file || std::abs(ratio - 1) < 1e-9;
    const double scale = keep ? 1.0 : std::cbrt(ratio);
    mesh.size = scale * size;
    mesh.domain = box_domain(mesh.size);
    result_.origin = low;
    result_.scale = scale;
    if (low == Vec3::Zero() && scale == 1.0) return;
    for (Vec3& x : mesh.nodes)
      for (int i = 0; i < 3; ++i) x[i] = x[i] == high[i] ? mesh.size[i] : scale * (x[i] - low[i]);
  }

  void give_orientations() {
    if (content_.orientations.empty()) return;
    result_.orientations.emplace();
    for (const int id : result_.grain_ids) {
      const auto found = content_.orientations.find(id);
      if (found == content_.orientations.end())
        fail(fmt::format("grain {} has no line in $ElsetOrientations", id));
      result_.orientations->push_back(found->second);
    }
  }

  void finish() {
    Mesh& mesh = result_.mesh;
    try {
      check_elements();
      find_grain_topology(mesh, result_.grain_ids);
      mesh.topology.check();
      check(mesh);
    } catch (const core::InputError& e) {
      fail(e.what());
    } catch (const core::InternalError& e) {
      fail(fmt::format("no valid mesh of a polycrystal: {} (numbers here from 0)", e.what()));
    }
  }

  void check_elements() const {
    const Mesh& mesh = result_.mesh;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto& t = mesh.tetrahedra[e];
      core::Mat3 sides;
      for (int i = 0; i < 3; ++i) sides.col(i) = mesh.nodes[t[i + 1]] - mesh.nodes[t[0]];
      const double volume = sides.determinant() / 6;
      if (!(volume > 0))
        fail(
            fmt::format("element {} of grain {} has volume {:.6g} between its corners; elements "
                        "must be positive",
                        content_.tetrahedra[result_.file_rows[e]].number,
                        result_.grain_ids[mesh.tetrahedron_cell[e]], volume));
    }
  }

  std::string path_;
  MshContent content_;
  LengthUnit unit_;
  MeshFile result_;
};

}  // namespace

MeshFile read_msh(const std::string& path, LengthUnit unit) { return MshReader(path, unit).read(); }

}  // namespace polyslip::mesh
