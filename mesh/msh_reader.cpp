#include "mesh/msh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/error.hpp"
#include "mesh/grain_topology.hpp"
#include "mesh/orientation_block.hpp"
#include "mesh/text_scanner.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

struct Element {
  std::array<int, 10> nodes;  ///< the file's ids, -1 for mid nodes of order 1
  int physical, elementary;
  int number;  ///< in the file
};

class MshReader {
 public:
  MshReader(const std::string& path, LengthUnit unit)
      : in_(path, read_maybe_compressed(path)), unit_(unit) {}

  MeshFile read() {
    read_sections();
    if (elements_.empty()) fail("there are no tetrahedra");
    sort_by_grain();
    number_nodes();
    place_in_box();
    give_orientations();
    finish();
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError(in_.path() + ": " + what);
  }

  void read_sections() {
    in_.expect("$MeshFormat");
    const std::string version(in_.word("the version"));
    if (version != "2.2")
      in_.fail(
          fmt::format("version {} of Gmsh's format; 2.2 is read (gmsh -format msh22)", version));
    if (in_.integer("the file type") != 0) in_.fail("the file is binary; only ASCII is read");
    in_.integer("the size of a number");
    in_.expect("$EndMeshFormat");
    bool nodes = false, elements = false;
    while (!in_.peek().empty()) {
      const std::string heading(in_.word("a section"));
      if (heading[0] != '$' || heading.starts_with("$End"))
        in_.fail(fmt::format("'{}' where a section should begin", heading));
      if (heading == "$Nodes")
        read_nodes(nodes);
      else if (heading == "$Elements")
        read_elements(elements);
      else if (heading == "$ElsetOrientations")
        read_orientations();
      else
        skip_to_end_of(heading);
    }
    if (!nodes) fail("there is no section $Nodes");
    if (!elements) fail("there is no section $Elements");
  }

  void skip_to_end_of(const std::string& heading) {
    const std::string end = "$End" + heading.substr(1);
    while (in_.peek() != end)
      if (in_.word(end.c_str()).starts_with("$End"))
        in_.fail(fmt::format("another end inside the section {}", heading));
    in_.expect(end);
  }

  void once(bool& seen, const char* section) {
    if (seen) in_.fail(fmt::format("a second section {}", section));
    seen = true;
  }

  void read_nodes(bool& seen) {
    once(seen, "$Nodes");
    const int count = in_.count("the number of nodes");
    ids_.reserve(count);
    for (int i = 0; i < count; ++i) {
      ids_.push_back({in_.integer("the id of a node"), i});
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = in_.number("a coordinate of a node");
      positions_.push_back(x);
    }
    in_.expect("$EndNodes");
    std::sort(ids_.begin(), ids_.end());
    for (std::size_t i = 1; i < ids_.size(); ++i)
      if (ids_[i].first == ids_[i - 1].first)
        fail(fmt::format("node {} is there twice", ids_[i].first));
  }

  void read_elements(bool& seen) {
    once(seen, "$Elements");
    const int count = in_.count("the number of elements");
    for (int i = 0; i < count; ++i) read_element();
    in_.expect("$EndElements");
  }

  void read_element() {
    const int number = in_.integer("the number of an element");
    const int type = in_.integer("the type of an element");
    constexpr std::array<int, 7> lower{1, 2, 3, 8, 9, 10, 15};  // points, lines and surfaces
    if (type != 4 && type != 11) {
      if (std::find(lower.begin(), lower.end(), type) == lower.end())
        in_.fail(
            fmt::format("element {} is of Gmsh's type {}; volumes must be tetrahedra of 4 or "
                        "10 nodes (types 4 and 11)",
                        number, type));
      in_.rest_of_line();
      return;
    }
    const int order = type == 11 ? 2 : 1;
    if (!elements_.empty() && order != result_.mesh.order)
      in_.fail(fmt::format("element {} is of order {}, others are not", number, order));
    result_.mesh.order = order;
    Element e{{}, 0, 0, number};
    const int tags = in_.count("the number of tags of an element");
    for (int t = 0; t < tags; ++t) {
      const int tag = in_.integer("a tag of an element");
      if (t == 0) e.physical = tag;
      if (t == 1) e.elementary = tag;
    }
    e.nodes.fill(-1);
    for (int n = 0; n < (order == 2 ? 10 : 4); ++n)
      e.nodes[n] = in_.integer("a node of an element");
    elements_.push_back(e);
  }

  void read_orientations() {
    const int count = in_.count("the number of orientations");
    read_orientation_convention(in_);
    for (int i = 0; i < count; ++i) {
      const int grain = in_.integer("the id of a grain");
      if (!by_grain_.emplace(grain, read_orientation(in_)).second)
        in_.fail(fmt::format("a second orientation of grain {}", grain));
    }
    in_.expect("$EndElsetOrientations");
  }

  void sort_by_grain() {
    const bool physical = std::any_of(elements_.begin(), elements_.end(),
                                      [](const Element& e) { return e.physical != 0; });
    const auto grain = [&](int i) {
      return physical ? elements_[i].physical : elements_[i].elementary;
    };
    auto& rows = result_.file_rows;
    rows.resize(elements_.size());
    std::iota(rows.begin(), rows.end(), 0);
    std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return grain(a) < grain(b); });
    auto& ids = result_.grain_ids;
    for (const int row : rows) {
      if (grain(row) < 1)
        fail(fmt::format("element {} has no physical volume to tell its grain",
                         elements_[row].number));
      if (ids.empty() || ids.back() != grain(row)) ids.push_back(grain(row));
      result_.mesh.tetrahedron_cell.push_back(static_cast<int>(ids.size()) - 1);
    }
    result_.mesh.topology.cell_faces.resize(ids.size());
  }

  /// Nodes that tetrahedra use get numbers, in the order of the file.
  void number_nodes() {
    Mesh& mesh = result_.mesh;
    std::vector<int> used(positions_.size(), -1);
    for (const int row : result_.file_rows) {
      const Element& e = elements_[row];
      std::array<int, 10> nodes;
      for (int i = 0; i < 10; ++i) nodes[i] = i >= 4 && mesh.order == 1 ? -1 : place_of(e, i);
      for (const int n : nodes)
        if (n >= 0) used[n] = 0;
      mesh.tetrahedra.push_back(nodes);
    }
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i] == 0) {
        used[i] = mesh.node_count();
        mesh.nodes.push_back(positions_[i]);
      }
    for (auto& t : mesh.tetrahedra)
      for (int& n : t)
        if (n >= 0) n = used[n];
  }

  int place_of(const Element& e, int i) const {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), std::pair{e.nodes[i], 0});
    if (found == ids_.end() || found->first != e.nodes[i])
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
    if (low == Vec3::Zero() && scale == 1.0) return;
    for (Vec3& x : mesh.nodes)
      for (int i = 0; i < 3; ++i) x[i] = x[i] == high[i] ? mesh.size[i] : scale * (x[i] - low[i]);
  }

  void give_orientations() {
    if (by_grain_.empty()) return;
    result_.orientations.emplace();
    for (const int id : result_.grain_ids) {
      const auto found = by_grain_.find(id);
      if (found == by_grain_.end())
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
                        elements_[result_.file_rows[e]].number,
                        result_.grain_ids[mesh.tetrahedron_cell[e]], volume));
    }
  }

  TextScanner in_;
  LengthUnit unit_;
  MeshFile result_;
  std::vector<std::pair<int, int>> ids_;  ///< the file's id of a node and its place, sorted
  std::vector<Vec3> positions_;
  std::vector<Element> elements_;
  std::map<int, core::Quaternion> by_grain_;
};

}  // namespace

MeshFile read_msh(const std::string& path, LengthUnit unit) { return MshReader(path, unit).read(); }

}  // namespace polyslip::mesh
