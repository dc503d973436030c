#include "mesh/msh_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "mesh/msh_numbers.hpp"
#include "mesh/orientation_block.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// Gmsh's number of an element type, and how many nodes it has.
struct ElementType {
  int type, nodes;
};
constexpr std::array<ElementType, 10> known_types{
    {{1, 2}, {2, 3}, {3, 4}, {4, 4}, {8, 3}, {9, 6}, {10, 9}, {11, 10}, {15, 1}, {16, 8}}};

constexpr bool is_tetrahedron(int type) { return type == 4 || type == 11; }
constexpr bool is_triangle(int type) { return type == 2 || type == 9; }

class MshParser {
 public:
  explicit MshParser(const std::string& path)
      : in_(path, read_maybe_compressed(path)), numbers_(in_) {}

  MshContent parse() {
    read_format();
    while (!in_.peek().empty()) read_section();
    if (!nodes_seen_) fail("there is no section $Nodes");
    if (!elements_seen_) fail("there is no section $Elements");
    if (element_orientations_ && content_.orientations.empty())
      fail(
          "orientations are those of single elements ($ElementOrientations); those of grains "
          "($ElsetOrientations) are read");
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError(in_.path() + ": " + what);
  }

  void read_format() {
    in_.expect("$MeshFormat");
    const std::string version(in_.word("the version"));
    if (version != "2.2" && version != "4.1")
      in_.fail(fmt::format(
          "version {} of Gmsh's format; 2.2 and 4.1 are read (gmsh -save -format msh41)", version));
    newest_ = version == "4.1";
    const int type = in_.integer("the file type");
    if (type != 0 && type != 1)
      in_.fail(fmt::format("file type {}; 0 (ASCII) and 1 (binary) are read", type));
    const int size = in_.integer("the size of a number");
    if (type == 1) {
      if (size != 8) in_.fail(fmt::format("numbers of {} bytes; binary files need 8", size));
      numbers_.begin_binary();
    }
    in_.expect("$EndMeshFormat");
  }

  void read_section() {
    const std::string heading(in_.word("a section"));
    if (heading[0] != '$' || heading.starts_with("$End"))
      in_.fail(fmt::format("'{}' where a section should begin", heading));
    if (heading == "$Nodes")
      once(nodes_seen_, "$Nodes"), newest_ ? read_nodes_41() : read_nodes_22();
    else if (heading == "$Elements")
      once(elements_seen_, "$Elements"), newest_ ? read_elements_41() : read_elements_22();
    else if (heading == "$Entities" && newest_)
      read_entities();
    else if (heading == "$Periodic")
      newest_ ? read_periodic_41() : read_periodic_22();
    else if (heading == "$PhysicalNames")
      read_names();
    else if (heading == "$ElsetOrientations")
      read_orientations();
    else if (heading == "$Groups")
      read_groups();
    else if (heading == "$PartitionedEntities")
      in_.fail("the mesh is partitioned; save it in one part (gmsh -part 1)");
    else
      skip(heading);
  }

  void skip(const std::string& heading) {
    element_orientations_ |= heading == "$ElementOrientations";
    const std::string end = "$End" + heading.substr(1);
    if (numbers_.binary()) return in_.skip_past("\n" + end);
    while (in_.peek() != end)
      if (in_.word(end.c_str()).starts_with("$End"))
        in_.fail(fmt::format("another end inside the section {}", heading));
    in_.expect(end);
  }

  void once(bool& seen, const char* section) {
    if (seen) in_.fail(fmt::format("a second section {}", section));
    seen = true;
  }

  Vec3 read_point() {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = numbers_.number("a coordinate of a node");
    return x;
  }

  void add_node(int id, const Vec3& x) {
    content_.node_ids.push_back({id, static_cast<int>(content_.positions.size())});
    content_.positions.push_back(x);
  }

  void end_nodes() {
    in_.expect("$EndNodes");
    auto& ids = content_.node_ids;
    if (!std::is_sorted(ids.begin(), ids.end())) std::sort(ids.begin(), ids.end());
    for (std::size_t i = 1; i < ids.size(); ++i)
      if (ids[i].first == ids[i - 1].first)
        fail(fmt::format("node {} is there twice", ids[i].first));
  }

  void read_nodes_22() {
    const int count = in_.count("the number of nodes");
    numbers_.end_line();
    content_.node_ids.reserve(count);
    content_.positions.reserve(count);
    for (int i = 0; i < count; ++i) {
      const int id = numbers_.integer("the id of a node");
      add_node(id, read_point());
    }
    end_nodes();
  }

  void read_nodes_41() {
    numbers_.end_line();
    const int blocks = numbers_.wide_count("the number of node blocks", 12);
    const int count = numbers_.wide_count("the number of nodes", 32);
    numbers_.wide("the smallest id of a node");
    numbers_.wide("the largest id of a node");
    for (int b = 0; b < blocks; ++b) read_node_block();
    if (static_cast<int>(content_.positions.size()) != count)
      in_.fail(fmt::format("{} nodes in blocks, {} at the head of the section",
                           content_.positions.size(), count));
    end_nodes();
  }

  void read_node_block() {
    const int dimension = numbers_.integer("the dimension of a node block");
    numbers_.integer("the entity of a node block");
    const int parameters =
        numbers_.integer("whether nodes are parametric") != 0 ? std::clamp(dimension, 0, 3) : 0;
    const int count = numbers_.wide_count("the number of nodes of a block", 32);
    std::vector<int> ids;
    ids.reserve(count);
    for (int i = 0; i < count; ++i) ids.push_back(numbers_.wide("the id of a node"));
    for (const int id : ids) {
      add_node(id, read_point());
      for (int p = 0; p < parameters; ++p) numbers_.number("a parameter of a node");
    }
  }

  int nodes_of(int type) const {
    for (const ElementType& known : known_types)
      if (known.type == type) return known.nodes;
    in_.fail(
        fmt::format("elements of Gmsh's type {}; volumes must be tetrahedra of 4 or 10 nodes "
                    "(types 4 and 11)",
                    type));
  }

  void read_elements_22() {
    const int count = in_.count("the number of elements");
    numbers_.end_line();
    if (!numbers_.binary()) {
      for (int i = 0; i < count; ++i) read_element_line();
    } else {
      for (int i = 0; i < count;) {
        const int type = numbers_.integer("the type of elements");
        const int here = numbers_.integer("the number of elements of a type");
        const int tags = numbers_.integer("the number of tags of an element");
        if (here < 1 || here > count - i)
          in_.fail(fmt::format("{} elements of a type, of {} left", here, count - i));
        for (int j = 0; j < here; ++j) {
          const int number = numbers_.integer("the number of an element");
          read_tagged(number, type, tags);
        }
        i += here;
      }
    }
    in_.expect("$EndElements");
  }

  void read_element_line() {
    const int number = in_.integer("the number of an element");
    const int type = in_.integer("the type of an element");
    nodes_of(type);
    if (!is_tetrahedron(type) && !is_triangle(type)) {
      in_.rest_of_line();
      return;
    }
    read_tagged(number, type, in_.count("the number of tags of an element"));
  }

  void read_tagged(int number, int type, int tags) {
    int physical = 0, elementary = 0;
    for (int t = 0; t < tags; ++t) {
      const int tag = numbers_.integer("a tag of an element");
      if (t == 0) physical = tag;
      if (t == 1) elementary = tag;
    }
    read_corners(number, type, physical, elementary,
                 [&] { return numbers_.integer("a node of an element"); });
  }

  template <class Take>
  void read_corners(int number, int type, int physical, int elementary, const Take& take) {
    const int count = nodes_of(type);
    std::array<int, 10> nodes;
    nodes.fill(-1);
    for (int n = 0; n < count; ++n) nodes[n] = take();
    if (is_triangle(type) && physical != 0)
      content_.triangles.push_back({{nodes[0], nodes[1], nodes[2]}, physical});
    if (!is_tetrahedron(type)) return;
    const int order = type == 11 ? 2 : 1;
    if (!content_.tetrahedra.empty() && order != content_.order)
      in_.fail(fmt::format("element {} is of order {}, others are not", number, order));
    content_.order = order;
    content_.tetrahedra.push_back({nodes, physical, elementary, number});
  }

  void read_elements_41() {
    numbers_.end_line();
    const int blocks = numbers_.wide_count("the number of element blocks", 20);
    const int count = numbers_.wide_count("the number of elements", 16);
    numbers_.wide("the smallest number of an element");
    numbers_.wide("the largest number of an element");
    int found = 0;
    for (int b = 0; b < blocks; ++b) found += read_element_block();
    if (found != count)
      in_.fail(fmt::format("{} elements in blocks, {} at the head of the section", found, count));
    in_.expect("$EndElements");
  }

  int read_element_block() {
    const int dimension = numbers_.integer("the dimension of an element block");
    const int entity = numbers_.integer("the entity of an element block");
    const int type = numbers_.integer("the type of elements");
    const int count = numbers_.wide_count("the number of elements of a block", 16);
    nodes_of(type);
    const auto physical = physical_.find({dimension, entity});
    for (int i = 0; i < count; ++i) {
      const int number = numbers_.wide("the number of an element");
      read_corners(number, type, physical == physical_.end() ? 0 : physical->second, entity,
                   [&] { return numbers_.wide("a node of an element"); });
    }
    return count;
  }

  void read_entities() {
    numbers_.end_line();
    std::array<int, 4> counts{};
    for (int& count : counts) count = numbers_.wide_count("the number of entities", 4);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (int i = 0; i < counts[dimension]; ++i) read_entity(dimension);
    in_.expect("$EndEntities");
  }

  void read_entity(int dimension) {
    const int tag = numbers_.integer("the tag of an entity");
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) numbers_.number("a bound of an entity");
    const int physical = numbers_.wide_count("the number of physical tags of an entity", 4);
    for (int i = 0; i < physical; ++i) {
      const int id = numbers_.integer("a physical tag of an entity");
      if (i == 0) physical_[{dimension, tag}] = id;
    }
    if (dimension == 0) return;
    const int bounds = numbers_.wide_count("the number of bounding entities", 4);
    for (int i = 0; i < bounds; ++i) numbers_.integer("a bounding entity");
  }

  void read_names() {
    const int count = in_.count("the number of physical names");
    for (int i = 0; i < count; ++i) {
      const int dimension = in_.integer("the dimension of a physical name");
      const int id = in_.integer("the id of a physical name");
      const std::string_view rest = in_.rest_of_line();
      const auto begin = rest.find('"'), end = rest.rfind('"');
      if (begin == end) in_.fail("a physical name must stand in quotes");
      content_.names[{dimension, id}] = std::string(rest.substr(begin + 1, end - begin - 1));
    }
    in_.expect("$EndPhysicalNames");
  }

  /// Text in binary files too.
  void read_periodic_22() {
    const int count = in_.count("the number of periodic entities");
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) in_.integer("a periodic entity");
      MshContent::Link link;
      if (in_.peek() == "Affine") {
        in_.expect("Affine");
        link.translation = read_affine([&] { return in_.number("a number of an affine motion"); });
      }
      const int nodes = in_.count("the number of periodic nodes");
      for (int n = 0; n < nodes; ++n) {
        const int slave = in_.integer("a periodic node");
        link.nodes.push_back({slave, in_.integer("the node of which one is a copy")});
      }
      content_.links.push_back(std::move(link));
    }
    in_.expect("$EndPeriodic");
  }

  void read_periodic_41() {
    numbers_.end_line();
    const int count = numbers_.wide_count("the number of periodic entities", 28);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) numbers_.integer("a periodic entity");
      MshContent::Link link;
      const int affine = numbers_.wide_count("the count of numbers of an affine motion", 8);
      if (affine != 0 && affine != 16)
        in_.fail(fmt::format("an affine motion has {} numbers, neither 0 nor 16", affine));
      if (affine == 16)
        link.translation =
            read_affine([&] { return numbers_.number("a number of an affine motion"); });
      const int nodes = numbers_.wide_count("the number of periodic nodes", 16);
      for (int n = 0; n < nodes; ++n) {
        const int slave = numbers_.wide("a periodic node");
        link.nodes.push_back({slave, numbers_.wide("the node of which one is a copy")});
      }
      content_.links.push_back(std::move(link));
    }
    in_.expect("$EndPeriodic");
  }

  template <class Number>
  Vec3 read_affine(const Number& number) {
    Vec3 translation;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) {
        const double value = number();
        if (row < 3 && column == 3)
          translation[row] = value;
        else if (!(std::abs(value - (row == column ? 1 : 0)) <= 1e-9))
          in_.fail("a periodic motion is no translation; only translations are read");
      }
    return translation;
  }

  void read_orientations() {
    const int count = in_.count("the number of orientations");
    const OrientationDescriptor descriptor = read_orientation_descriptor(in_);
    for (int i = 0; i < count; ++i) {
      const int grain = in_.integer("the id of a grain");
      if (!content_.orientations.emplace(grain, read_orientation(in_, descriptor)).second)
        in_.fail(fmt::format("a second orientation of grain {}", grain));
    }
    // Neper's documentation has both.
    if (in_.peek() == "$EndOrientations")
      in_.word("an end");
    else
      in_.expect("$EndElsetOrientations");
  }

  void read_groups() {
    const std::string of(in_.word("what the groups are of"));
    if (of != "elset") in_.fail(fmt::format("groups of '{}'; those of elset are read", of));
    const int count = in_.count("the number of groups");
    for (int i = 0; i < count; ++i) {
      const int grain = in_.integer("the id of a grain");
      content_.groups[grain] = in_.integer("the group of a grain");
    }
    in_.expect("$EndGroups");
  }

  TextScanner in_;
  MshNumbers numbers_;
  MshContent content_;
  bool newest_ = false, nodes_seen_ = false, elements_seen_ = false;
  bool element_orientations_ = false;
  std::map<std::pair<int, int>, int> physical_;  ///< of dimension and entity
};

}  // namespace

MshContent parse_msh(const std::string& path) { return MshParser(path).parse(); }

}  // namespace polyslip::mesh
