#include "mesh/msh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/error.hpp"
#include "mesh/grain_topology.hpp"
#include "mesh/mesh_domain.hpp"
#include "mesh/msh_parser.hpp"
#include "mesh/msh_periodic.hpp"

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
    place();
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
    auto& used = numbers_;
    used.assign(content_.positions.size(), -1);
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

  /// The place of a node in the file.
  std::optional<int> find_node(int id) const {
    const auto& ids = content_.node_ids;
    const auto found = std::lower_bound(ids.begin(), ids.end(), std::pair{id, 0});
    if (found == ids.end() || found->first != id) return {};
    return found->second;
  }

  int place_of(const Element& e, int i) const {
    const auto found = find_node(e.nodes[i]);
    if (!found)
      fail(fmt::format("element {} has node {}, which is not in $Nodes", e.number, e.nodes[i]));
    return *found;
  }

  /// Names of the physical surfaces, by the corners of their triangles.
  std::map<std::array<int, 3>, std::string> surfaces() const {
    std::map<std::array<int, 3>, std::string> found;
    for (const auto& triangle : content_.triangles) {
      const auto name = content_.names.find({2, triangle.physical});
      if (name == content_.names.end()) continue;
      std::array<int, 3> corners;
      for (int i = 0; i < 3; ++i) {
        const auto at = find_node(triangle.corners[i]);
        corners[i] = at ? numbers_[*at] : -1;
      }
      std::sort(corners.begin(), corners.end());
      if (corners[0] >= 0) found[corners] = name->second;
    }
    return found;
  }

  void place() {
    Mesh& mesh = result_.mesh;
    Vec3 low = mesh.nodes[0], high = low;
    for (const Vec3& x : mesh.nodes) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    if (!((high - low).minCoeff() > 0)) fail("the box of the nodes has no volume");
    check_elements();
    if (!content_.links.empty())
      place_in_periodic_box(low, high);
    else if (const auto walls = find_walls(mesh, surfaces()))
      place_in_polyhedron(*walls, low, high);
    else
      place_in_box(low, high);
  }

  double scale_for(double volume) const {
    const double ratio = result_.mesh.topology.cell_count() / volume;
    return unit_ == LengthUnit::file || std::abs(ratio - 1) < 1e-9 ? 1.0 : std::cbrt(ratio);
  }

  /// Links with the numbers that nodes have in the mesh; where a link tells no translation, that of
  /// its nodes.
  std::vector<PeriodicLink> links() const {
    std::vector<PeriodicLink> links;
    for (const auto& row : content_.links) {
      PeriodicLink link;
      Vec3 sum = Vec3::Zero();
      for (const auto& [slave, master] : row.nodes) {
        const auto from = find_node(master), to = find_node(slave);
        if (!from || !to)
          fail(fmt::format("$Periodic has node {}, which is not in $Nodes", from ? slave : master));
        if (numbers_[*from] < 0 || numbers_[*to] < 0) continue;  // of no tetrahedron
        link.nodes.push_back({numbers_[*to], numbers_[*from]});
        sum += content_.positions[*to] - content_.positions[*from];
      }
      if (link.nodes.empty()) continue;
      link.translation = row.translation.value_or(sum / static_cast<double>(link.nodes.size()));
      links.push_back(std::move(link));
    }
    return links;
  }

  /// Grains stick out of the box along its periodic directions, where it may begin anywhere: at the
  /// file's origin.
  void place_in_periodic_box(Vec3 low, Vec3 high) {
    Mesh& mesh = result_.mesh;
    PeriodicBox box;
    std::string fault;
    const double near = 1e-6 * (high - low).minCoeff();
    mesh.periodic_nodes = join_links(links(), mesh.nodes, near, box, fault);
    if (!fault.empty()) fail("$Periodic: " + fault);
    for (int k = 0; k < 3; ++k)
      if (box.directions[k]) low[k] = 0, high[k] = box.periods[k];
    const Vec3 size = high - low;
    const double scale = scale_for(size.prod());
    mesh.domain = box_domain(scale * size);
    mesh.domain.periodic = box.directions;
    move(low, high, scale);
    for (const auto& pair : mesh.periodic_nodes)
      mesh.nodes[pair.slave] = translated(mesh.nodes[pair.master], pair.shift, mesh.size);
  }

  void place_in_box(const Vec3& low, const Vec3& high) {
    const Vec3 size = high - low;
    const double scale = scale_for(size.prod());
    result_.mesh.domain = box_domain(scale * size);
    move(low, high, scale);
  }

  void place_in_polyhedron(const MeshWalls& walls, const Vec3& low, const Vec3& high) {
    Mesh& mesh = result_.mesh;
    try {
      mesh.domain = convex_domain("polyhedron", walls.planes, walls.names);
      const double scale = scale_for(mesh.domain.volume);
      if (scale != 1)
        mesh.domain =
            convex_domain("polyhedron", walls.planes, walls.names, mesh.topology.cell_count());
      move(low, high, scale);
    } catch (const core::InputError& e) {
      fail(fmt::format("the surface of the mesh is that of no convex body: {}", e.what()));
    }
  }

  void move(const Vec3& low, const Vec3& high, double scale) {
    Mesh& mesh = result_.mesh;
    mesh.size = mesh.domain.size;
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
      find_grain_topology(mesh, result_.grain_ids);
      mesh.topology.check(mesh.domain.face_count());
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
  std::vector<int> numbers_;  ///< of the file's nodes in the mesh; -1: not used
};

}  // namespace

MeshFile read_msh(const std::string& path, LengthUnit unit) { return MshReader(path, unit).read(); }

}  // namespace polyslip::mesh
