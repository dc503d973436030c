#include "results/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"

namespace polyslip::results {
namespace {

using hdf5::Number;

bool is_number(const std::string& word) {
  return word.find_first_not_of("0123456789") == std::string::npos;
}

bool covers(const DatasetSpec& spec, const std::string& name) {
  if (!spec.name.ends_with("/*")) return spec.name == name;
  const std::string group = spec.name.substr(0, spec.name.size() - 1);
  return name.size() > group.size() && name.starts_with(group) &&
         name.find('/', group.size()) == std::string::npos;
}

std::vector<DatasetSpec> make_schema() {
  const auto f64 = Number::float64;
  const auto i32 = Number::int32;
  const auto u8 = Number::uint8;
  const std::string length = "L";
  return {
      {"time", f64, {}, "s", "file", "Time."},
      {"strain", f64, {}, "1", "file", "True compressive strain ln(h0/h)."},
      {"mesh/number", i32, {}, "-", "file", "0 for the first mesh, one more after each remeshing."},
      {"mesh/order", i32, {}, "-", "file", "2: ten-node tetrahedra; 1: mid nodes are -1."},
      {"mesh/size", f64, {"3"}, length, "file", "Edge lengths of the box at zero strain."},
      {"mesh/nodes", f64, {"nodes", "3"}, length, "node", "Current positions (deformed)."},
      {"mesh/tetrahedra",
       i32,
       {"elements", "10"},
       "-",
       "element",
       "Nodes (from 0) in Gmsh's order: corners, then mid nodes of 01 12 20 30 32 31. Same "
       "elements "
       "in the same order as in mesh-NNN.msh."},
      {"mesh/tetrahedra_vtk",
       i32,
       {"elements", "corners_and_mids"},
       "-",
       "element",
       "The same in VTK's and XDMF's order: mid nodes of 01 12 20 03 13 23 (order 1: corners "
       "only)."},
      {"mesh/grain",
       i32,
       {"elements"},
       "-",
       "element",
       "Grain, from 1; elements are sorted by it."},
      {"mesh/triangles",
       i32,
       {"triangles", "6"},
       "-",
       "triangle",
       "Nodes of the triangles on grain and domain boundaries: corners, mid nodes of 01 12 20; the "
       "normal points out of the face's first grain."},
      {"mesh/triangle_face", i32, {"triangles"}, "-", "triangle", "Face (from 0); sorted."},
      {"mesh/lines",
       i32,
       {"lines", "3"},
       "-",
       "line",
       "Nodes of the lines on edges of the polycrystal: from, to, mid."},
      {"mesh/line_edge", i32, {"lines"}, "-", "line", "Edge (from 0); sorted."},
      {"mesh/vertex_nodes", i32, {"vertices"}, "-", "vertex", "Node at each vertex."},
      {"topology/edges", i32, {"edges", "2"}, "-", "edge", "Vertices (from 0): from, to."},
      {"topology/face_cells",
       i32,
       {"faces", "2"},
       "-",
       "face",
       "Grains (from 0) on both sides; the normal points out of the first; -1: outside."},
      {"topology/face_domain",
       i32,
       {"faces"},
       "-",
       "face",
       "0 ... 5 for x0 x1 y0 y1 z0 z1, -1 inside."},
      {"topology/face_edge_start",
       i32,
       {"faces_and_one"},
       "-",
       "face",
       "Where a face's loop begins in face_edges; the last entry is their number."},
      {"topology/face_edges",
       i32,
       {"face_edges"},
       "-",
       "edge of a face",
       "Edges in the order of the loop."},
      {"topology/face_edge_forward",
       u8,
       {"face_edges"},
       "-",
       "edge of a face",
       "1: the loop runs along the edge from its first vertex to its second."},
      {"topology/cell_face_start",
       i32,
       {"cells_and_one"},
       "-",
       "grain",
       "Where a grain's faces begin in cell_faces; the last entry is their number."},
      {"topology/cell_faces", i32, {"cell_faces"}, "-", "face of a grain", "Faces of the grains."},
      {"nodes/displacement",
       f64,
       {"nodes", "3"},
       length,
       "node",
       "From the positions in the first mesh, carried through remeshings by shape functions."},
      {"elements/volume", f64, {"elements"}, "L^3", "element", "Current volume."},
      {"elements/orientation",
       f64,
       {"elements", "4"},
       "1",
       "element",
       "Mean unit quaternion w x y z; its matrix turns crystal axes into sample axes. Continuous "
       "along a run: no symmetry operation applied."},
      {"elements/colour",
       u8,
       {"elements", "3"},
       "-",
       "element",
       "Red, green, blue, 255 (v_i + sqrt 2 - 1) / (2 (sqrt 2 - 1)), v the Rodrigues vector of the "
       "mean orientation in the cubic fundamental region."},
      {"elements/g", f64, {"elements"}, "MPa", "element", "Slip resistance, mean of the systems'."},
      {"elements/slip",
       f64,
       {"elements"},
       "1",
       "element",
       "Accumulated slip, summed over the systems."},
      {"elements/equivalent_strain",
       f64,
       {"elements"},
       "1",
       "element",
       "Accumulated equivalent plastic strain, the integral of sqrt(2/3 Dp:Dp)."},
      {"elements/cauchy_stress",
       f64,
       {"elements", "6"},
       "MPa",
       "element",
       "xx yy zz yz zx xy, sample axes."},
      {"elements/pressure", f64, {"elements"}, "MPa", "element", "-(xx + yy + zz)/3."},
      {"quadrature_points",
       i32,
       {},
       "-",
       "file",
       "Points an element: 4, 8, 14 or 15. Point i of four is the one nearest to corner i; the "
       "first "
       "of fifteen is the centroid."},
      {"state/node/*", f64, {"nodes", "components"}, "", "node", "Fields of the computation."},
      {"state/element/*",
       f64,
       {"elements", "components"},
       "",
       "element",
       "Fields of the computation."},
      {"state/point/*",
       f64,
       {"points", "components"},
       "",
       "quadrature point",
       "Fields of the computation; row = element x quadrature_points + point."},
      {"history/*", f64, {"values"}, "", "file", "What a restart needs of the solver's history."},
  };
}

}  // namespace

const std::vector<DatasetSpec>& state_schema() {
  static const std::vector<DatasetSpec> schema = make_schema();
  return schema;
}

const DatasetSpec& dataset_spec(const std::string& name) {
  for (const auto& spec : state_schema())
    if (covers(spec, name)) return spec;
  throw core::InternalError(
      fmt::format("results/schema: no dataset '{}' in the table of a state file", name));
}

std::vector<std::uint64_t> TableWriter::shape_of(const DatasetSpec& spec,
                                                 const std::string& name) const {
  std::vector<std::uint64_t> shape;
  for (const auto& word : spec.shape) {
    if (!is_number(word) && !sizes_.contains(word))
      throw core::InternalError(
          fmt::format("results/schema: {}: size of '{}' not set", name, word));
    shape.push_back(is_number(word) ? std::stoull(word) : sizes_.at(word));
  }
  return shape;
}

void TableWriter::describe(const DatasetSpec& spec, const std::string& name) {
  if (!spec.unit.empty()) file_.write_attribute(name, "unit", spec.unit);
  file_.write_attribute(name, "location", spec.location);
  if (!spec.name.ends_with("/*")) file_.write_attribute(name, "description", spec.description);
}

void TableWriter::put(const std::string& name, Number type, const void* data, std::size_t count) {
  const auto& spec = dataset_spec(name);
  const auto shape = shape_of(spec, name);
  std::uint64_t expected = 1;
  for (const auto size : shape) expected *= size;
  if (type != spec.type || count != expected)
    throw core::InternalError(fmt::format("results/schema: {}: {} values for a shape of ({})", name,
                                          count, fmt::join(shape, ", ")));
  file_.write(name, type, shape, data);
  describe(spec, name);
}

void TableWriter::create(const std::string& name, Number type) {
  const auto& spec = dataset_spec(name);
  const auto shape = shape_of(spec, name);
  if (type != spec.type || shape.empty())
    throw core::InternalError(
        fmt::format("results/schema: {}: of another type, or without rows", name));
  file_.create_dataset(name, type, shape);
  describe(spec, name);
}

void TableWriter::put_rows(const std::string& name, Number type, std::uint64_t first,
                           const void* data, std::size_t count) {
  const auto& spec = dataset_spec(name);
  const auto shape = shape_of(spec, name);
  std::uint64_t each = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) each *= shape[i];
  const std::uint64_t rows = each > 0 ? count / each : 0;
  if (type != spec.type || rows * each != count || first + rows > shape.at(0))
    throw core::InternalError(
        fmt::format("results/schema: {}: {} values from row {} on for a shape of ({})", name, count,
                    first, fmt::join(shape, ", ")));
  if (rows > 0) file_.write_rows(name, type, first, rows, data);
}

std::size_t TableReader::expect(const std::string& name, Number type) {
  const auto& spec = dataset_spec(name);
  if (type != spec.type)
    throw core::InternalError(fmt::format("results/schema: {} read as another type", name));
  if (!file_.has(name))
    throw core::InputError(fmt::format("{}: dataset {} is missing", file_.path(), name));
  const auto shape = file_.shape(name, type);
  bool fits = shape.size() == spec.shape.size();
  std::size_t count = 1;
  for (std::size_t i = 0; fits && i < shape.size(); ++i) {
    const auto& word = spec.shape[i];
    const auto expected =
        is_number(word) ? std::stoull(word) : sizes_.try_emplace(word, shape[i]).first->second;
    fits = shape[i] == expected;
    count *= shape[i];
  }
  if (!fits)
    throw core::InputError(fmt::format("{}: dataset {} has shape ({}) where ({}) is expected",
                                       file_.path(), name, fmt::join(shape, ", "),
                                       fmt::join(spec.shape, ", ")));
  return count;
}

}  // namespace polyslip::results
