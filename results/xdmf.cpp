#include "results/xdmf.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "results/names.hpp"

namespace polyslip::results {
namespace {

struct Attribute {
  const char* name;
  const char* dataset;
  const char* center;
  const char* type;
  int components;
  const char* number;
};

/// Relative distance of two states at one time: readers take differences of round-off for none.
constexpr double same_time_gap = 1e-9;

// Four and six components have no XDMF type that keeps our order: matrices of one column.
constexpr Attribute attributes[] = {
    {"displacement", "nodes/displacement", "Node", "Vector", 3, "Float\" Precision=\"8"},
    {"grain", "mesh/grain", "Cell", "Scalar", 1, "Int\" Precision=\"4"},
    {"orientation", "elements/orientation", "Cell", "Matrix", 4, "Float\" Precision=\"8"},
    {"colour", "elements/colour", "Cell", "Vector", 3, "UChar\" Precision=\"1"},
    {"g", "elements/g", "Cell", "Scalar", 1, "Float\" Precision=\"8"},
    {"slip", "elements/slip", "Cell", "Scalar", 1, "Float\" Precision=\"8"},
    {"equivalent_strain", "elements/equivalent_strain", "Cell", "Scalar", 1,
     "Float\" Precision=\"8"},
    {"cauchy_stress", "elements/cauchy_stress", "Cell", "Matrix", 6, "Float\" Precision=\"8"},
    {"pressure", "elements/pressure", "Cell", "Scalar", 1, "Float\" Precision=\"8"},
};

std::string data_item(const StateRecord& s, const std::string& dataset, long rows, int columns,
                      const char* number) {
  const std::string size =
      columns == 1 ? fmt::format("{}", rows) : fmt::format("{} {}", rows, columns);
  return fmt::format(
      "<DataItem Format=\"HDF\" Dimensions=\"{}\" NumberType=\"{}\">{}/{}:/{}</DataItem>", size,
      number, results_folder, s.file, dataset);
}

std::string grid(const StateRecord& s, double time) {
  const int corners = s.order == 2 ? 10 : 4;
  std::string text = fmt::format(
      "      <Grid Name=\"strain {}\" GridType=\"Uniform\">\n"
      "        <Time Value=\"{}\"/>\n"
      "        <Information Name=\"strain\" Value=\"{}\"/>\n"
      "        <Information Name=\"mesh\" Value=\"{}\"/>\n"
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\">\n          {}\n"
      "        </Topology>\n"
      "        <Geometry GeometryType=\"XYZ\">\n          {}\n        </Geometry>\n",
      s.strain, time, s.strain, s.mesh_number, s.order == 2 ? "Tetrahedron_10" : "Tetrahedron",
      s.elements, data_item(s, "mesh/tetrahedra_vtk", s.elements, corners, "Int\" Precision=\"4"),
      data_item(s, "mesh/nodes", s.nodes, 3, "Float\" Precision=\"8"));
  for (const auto& a : attributes) {
    const long rows = std::string_view(a.center) == "Node" ? s.nodes : s.elements;
    text += fmt::format(
        "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n          {}\n"
        "        </Attribute>\n",
        a.name, a.type, a.center, data_item(s, a.dataset, rows, a.components, a.number));
  }
  return text + "      </Grid>\n";
}

}  // namespace

std::string xdmf_text(const std::vector<StateRecord>& states) {
  std::string text =
      "<?xml version=\"1.0\" ?>\n"
      "<Xdmf Version=\"3.0\">\n"
      "  <Domain>\n"
      "    <Grid Name=\"polyslip\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  double last = -std::numeric_limits<double>::infinity();
  for (const auto& state : states) {
    last = state.time > last ? state.time : last + same_time_gap * std::abs(last);
    text += grid(state, last);
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace polyslip::results
