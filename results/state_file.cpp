#include "results/state_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "results/checksum.hpp"
#include "results/element_values.hpp"
#include "results/orientation_state.hpp"
#include "results/schema.hpp"

namespace polyslip::results {
namespace {

using Ints = std::vector<std::int32_t>;
using Bytes = std::vector<std::uint8_t>;
using mesh::Location;

constexpr std::array<std::pair<Location, const char*>, 3> groups{
    {{Location::node, "state/node/"},
     {Location::element, "state/element/"},
     {Location::quadrature_point, "state/point/"}}};

constexpr std::array<std::pair<core::Transport, const char*>, 5> transports{
    {{core::Transport::element_average, "element_average"},
     {core::Transport::orientation_average, "orientation_average"},
     {core::Transport::reset_to_zero, "reset_to_zero"},
     {core::Transport::shape_functions, "shape_functions"},
     {core::Transport::not_carried, "not_carried"}}};

/// Mid nodes of VTK's quadratic tetrahedron (01 12 20 03 13 23) in Gmsh's (01 12 20 30 32 31).
constexpr std::array<int, 10> vtk_order{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

template <class Rows>
Ints flatten(const Rows& rows) {
  Ints flat;
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  return flat;
}

std::vector<double> flatten(const std::vector<core::Vec3>& rows) {
  std::vector<double> flat;
  flat.reserve(3 * rows.size());
  for (const auto& row : rows) flat.insert(flat.end(), {row[0], row[1], row[2]});
  return flat;
}

template <std::size_t N>
std::vector<std::array<int, N>> rows_of(const Ints& flat) {
  std::vector<std::array<int, N>> rows(flat.size() / N);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(i * N), N, rows[i].begin());
  return rows;
}

/// Where each list begins in the lists one after the other; the last entry is their total length.
template <class Rows>
Ints starts_of(const Rows& rows) {
  Ints starts{0};
  for (const auto& row : rows) starts.push_back(starts.back() + static_cast<int>(row.size()));
  return starts;
}

void write_topology(TableWriter& w, const mesh::Topology& t) {
  std::vector<std::array<int, 2>> edges, cells;
  std::vector<std::vector<int>> loops;
  Ints domain;
  Bytes forward;
  for (const auto& edge : t.edges) edges.push_back(edge.vertices);
  for (const auto& face : t.faces) {
    cells.push_back(face.cells);
    domain.push_back(face.domain_face);
    loops.push_back(face.edges);
    if (face.forward.size() != face.edges.size())
      throw core::InternalError("results/state_file: a face's loop has lost its directions");
    for (const bool f : face.forward) forward.push_back(f ? 1 : 0);
  }
  w.set_size("edges", edges.size());
  w.set_size("faces", cells.size());
  w.set_size("faces_and_one", cells.size() + 1);
  w.set_size("face_edges", forward.size());
  w.set_size("cells_and_one", t.cell_faces.size() + 1);
  w.set_size("cell_faces", static_cast<std::uint64_t>(starts_of(t.cell_faces).back()));
  w.put("topology/edges", flatten(edges));
  w.put("topology/face_cells", flatten(cells));
  w.put("topology/face_domain", domain);
  w.put("topology/face_edge_start", starts_of(loops));
  w.put("topology/face_edges", flatten(loops));
  w.put("topology/face_edge_forward", forward);
  w.put("topology/cell_face_start", starts_of(t.cell_faces));
  w.put("topology/cell_faces", flatten(t.cell_faces));
}

void write_mesh(TableWriter& w, const mesh::Mesh& m) {
  w.set_size("nodes", m.nodes.size());
  w.set_size("elements", m.tetrahedra.size());
  w.set_size("triangles", m.triangles.size());
  w.set_size("lines", m.lines.size());
  w.set_size("vertices", static_cast<std::uint64_t>(m.topology.vertex_count));
  const int vtk_nodes = m.order == 2 ? 10 : 4;
  w.set_size("corners_and_mids", static_cast<std::uint64_t>(vtk_nodes));
  Ints vtk, grain;
  for (const auto& nodes : m.tetrahedra)
    for (int i = 0; i < vtk_nodes; ++i) vtk.push_back(nodes[vtk_order[i]]);
  for (const int cell : m.tetrahedron_cell) grain.push_back(cell + 1);
  w.put_scalar<std::int32_t>("mesh/order", m.order);
  w.put("mesh/size", std::span<const double>(m.size.data(), 3));
  w.put("mesh/nodes", flatten(m.nodes));
  w.put("mesh/tetrahedra", flatten(m.tetrahedra));
  w.put("mesh/tetrahedra_vtk", vtk);
  w.put("mesh/grain", grain);
  w.put("mesh/triangles", flatten(m.triangles));
  w.put("mesh/triangle_face", m.triangle_face);
  w.put("mesh/lines", flatten(m.lines));
  w.put("mesh/line_edge", m.line_edge);
  w.put("mesh/vertex_nodes", m.vertex_nodes);
}

std::uint8_t colour_level(double level) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0)));
}

/// Calls write(first, last) for so many nodes or elements, a piece at a time.
template <class Write>
void in_pieces(std::size_t count, const Write& write) {
  constexpr std::size_t piece = 1 << 14;
  for (std::size_t first = 0; first < count; first += piece)
    write(first, std::min(first + piece, count));
}

void write_element_views(TableWriter& w, const ElementTable& t, std::size_t first) {
  std::vector<double> orientation, stress;
  Bytes colour;
  for (const auto& q : t.orientation) {
    orientation.insert(orientation.end(), {q.w(), q.x(), q.y(), q.z()});
    const core::Vec3 rgb =
        q.coeffs().allFinite() ? core::paper_colour(q) : core::Vec3::Constant(127.5);
    for (int i = 0; i < 3; ++i) colour.push_back(colour_level(rgb[i]));
  }
  for (const auto& v : t.cauchy_stress) stress.insert(stress.end(), v.begin(), v.end());
  w.put_rows("elements/volume", first, t.volume);
  w.put_rows("elements/orientation", first, orientation);
  w.put_rows("elements/colour", first, colour);
  w.put_rows("elements/g", first, t.g);
  w.put_rows("elements/slip", first, t.slip);
  w.put_rows("elements/equivalent_strain", first, t.equivalent_strain);
  w.put_rows("elements/cauchy_stress", first, stress);
  w.put_rows("elements/pressure", first, t.pressure);
}

/// What users look at: element means and the displacement (zero if the snapshot has none).
void write_views(TableWriter& w, const mesh::Snapshot& s, const mesh::FieldReader& read) {
  w.create<std::uint8_t>("elements/colour");
  for (const char* name :
       {"volume", "orientation", "g", "slip", "equivalent_strain", "cauchy_stress", "pressure"})
    w.create<double>(std::string("elements/") + name);
  in_pieces(s.mesh.tetrahedra.size(), [&](std::size_t first, std::size_t last) {
    write_element_views(w, element_values(s, read, ElementValue::average, first, last), first);
  });
  const auto* displacement = s.find("displacement", Location::node);
  w.create<double>("nodes/displacement");
  in_pieces(s.mesh.nodes.size(), [&](std::size_t first, std::size_t last) {
    w.put_rows("nodes/displacement", first,
               displacement != nullptr ? read(*displacement, first, last)
                                       : std::vector<double>(3 * (last - first), 0.0));
  });
}

void require_name(const std::string& name) {
  if (name.empty() || name == "." || name.find('/') != std::string::npos)
    throw core::InternalError(fmt::format("results/state_file: '{}' cannot name a dataset", name));
}

void write_fields(hdf5::File& file, TableWriter& w, const mesh::Snapshot& s,
                  const mesh::FieldReader& read) {
  w.set_size("points", s.mesh.tetrahedra.size() * static_cast<std::uint64_t>(s.quadrature_points));
  int index = 0;
  for (const auto& field : s.fields) {
    require_name(field.name);
    const auto group = std::find_if(groups.begin(), groups.end(),
                                    [&](const auto& g) { return g.first == field.location; });
    const auto transport = std::find_if(transports.begin(), transports.end(),
                                        [&](const auto& t) { return t.first == field.transport; });
    const std::string name = group->second + field.name;
    w.set_size("components", static_cast<std::uint64_t>(field.components));
    w.create<double>(name);
    const std::size_t rows_each =
        mesh::values_each(s, field) / static_cast<std::size_t>(field.components);
    in_pieces(mesh::owner_count(s, field), [&](std::size_t first, std::size_t last) {
      w.put_rows(name, first * rows_each, read(field, first, last));
    });
    file.write_attribute(name, "unit", field.unit);
    file.write_attribute(name, "transport", transport->second);
    file.write_attribute(name, "description", field.description);
    file.write_attribute(name, "index", index++);
  }
}

void write_all(hdf5::File& file, const mesh::Snapshot& s, const mesh::FieldReader& read) {
  file.write_attribute("/", "file_type", state_file_type);
  file.write_attribute("/", "version", state_file_version);
  TableWriter w(file);
  w.put_scalar("time", s.time);
  w.put_scalar("strain", s.strain);
  w.put_scalar<std::int32_t>("mesh/number", s.mesh_number);
  w.put_scalar<std::int32_t>("quadrature_points", s.quadrature_points);
  write_mesh(w, s.mesh);
  write_topology(w, s.mesh.topology);
  write_views(w, s, read);
  write_fields(file, w, s, read);
  for (const auto& [name, values] : s.history) {
    require_name(name);
    w.set_size("values", values.size());
    w.put("history/" + name, values);
  }
  for (const auto& [name, text] : s.provenance) {
    require_name(name);
    file.write_text("provenance/" + name, text);
  }
}

/// Bytes that the file will take, and some more.
std::uint64_t room_for(const mesh::Snapshot& s) {
  constexpr std::uint64_t a_node = 6 * 8, an_element = 2 * 40 + 4 + 15 * 8 + 3;
  constexpr std::uint64_t a_triangle = 28, a_line = 16, overhead = 1 << 18;
  std::uint64_t bytes = s.mesh.nodes.size() * a_node + s.mesh.tetrahedra.size() * an_element +
                        s.mesh.triangles.size() * a_triangle + s.mesh.lines.size() * a_line;
  for (const auto& field : s.fields)
    bytes += 8 * mesh::owner_count(s, field) * mesh::values_each(s, field);
  for (const auto& [name, text] : s.provenance) bytes += text.size();
  return bytes + bytes / 16 + overhead;
}

/// The lists that `starts` cuts `flat` into.
std::vector<std::vector<int>> lists_of(const Ints& starts, const Ints& flat,
                                       const std::string& path) {
  std::vector<std::vector<int>> lists;
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    if (starts[i] < 0 || starts[i] > starts[i + 1] || starts[i + 1] > static_cast<int>(flat.size()))
      throw core::InputError(path + ": lists of the topology do not fit together");
    lists.emplace_back(flat.begin() + starts[i], flat.begin() + starts[i + 1]);
  }
  return lists;
}

mesh::Topology read_topology(TableReader& r, const std::string& path) {
  mesh::Topology t;
  for (const auto& vertices : rows_of<2>(r.get<std::int32_t>("topology/edges")))
    t.edges.push_back({vertices});
  const auto cells = rows_of<2>(r.get<std::int32_t>("topology/face_cells"));
  const auto domain = r.get<std::int32_t>("topology/face_domain");
  const auto starts = r.get<std::int32_t>("topology/face_edge_start");
  const auto loops = lists_of(starts, r.get<std::int32_t>("topology/face_edges"), path);
  const auto forward = r.get<std::uint8_t>("topology/face_edge_forward");
  if (loops.size() != cells.size())
    throw core::InputError(path + ": lists of the topology do not fit together");
  for (std::size_t f = 0; f < cells.size(); ++f) {
    mesh::TopologyFace face;
    face.edges = loops[f];
    for (int i = starts[f]; i < starts[f + 1]; ++i) face.forward.push_back(forward[i] != 0);
    face.cells = cells[f];
    face.domain_face = domain[f];
    t.faces.push_back(std::move(face));
  }
  const auto cell_starts = r.get<std::int32_t>("topology/cell_face_start");
  t.cell_faces = lists_of(cell_starts, r.get<std::int32_t>("topology/cell_faces"), path);
  return t;
}

mesh::Mesh read_mesh(TableReader& r, const std::string& path) {
  mesh::Mesh m;
  m.order = r.get_scalar<std::int32_t>("mesh/order");
  const auto size = r.get<double>("mesh/size");
  m.size = core::Vec3(size[0], size[1], size[2]);
  m.domain = mesh::box_domain(m.size);
  const auto nodes = r.get<double>("mesh/nodes");
  for (std::size_t i = 0; i + 2 < nodes.size(); i += 3)
    m.nodes.emplace_back(nodes[i], nodes[i + 1], nodes[i + 2]);
  m.tetrahedra = rows_of<10>(r.get<std::int32_t>("mesh/tetrahedra"));
  for (const int grain : r.get<std::int32_t>("mesh/grain")) m.tetrahedron_cell.push_back(grain - 1);
  m.triangles = rows_of<6>(r.get<std::int32_t>("mesh/triangles"));
  m.triangle_face = r.get<std::int32_t>("mesh/triangle_face");
  m.lines = rows_of<3>(r.get<std::int32_t>("mesh/lines"));
  m.line_edge = r.get<std::int32_t>("mesh/line_edge");
  m.vertex_nodes = r.get<std::int32_t>("mesh/vertex_nodes");
  m.topology = read_topology(r, path);
  m.topology.vertex_count = static_cast<int>(r.size("vertices"));
  return m;
}

core::Transport transport_of(const std::string& text, const std::string& path) {
  for (const auto& [transport, name] : transports)
    if (text == name) return transport;
  throw core::InputError(fmt::format("{}: unknown transport rule '{}'", path, text));
}

std::vector<mesh::Field> read_fields(const hdf5::File& file, TableReader& r, int points) {
  r.set_size("points", r.size("elements") * static_cast<std::uint64_t>(points));
  std::vector<std::pair<int, mesh::Field>> found;
  for (const auto& [location, group] : groups)
    for (const auto& name : file.names(std::string(group, std::string(group).size() - 1))) {
      const std::string path = group + name;
      mesh::Field field;
      field.name = name;
      field.location = location;
      r.forget_size("components");
      field.values = r.get<double>(path);
      field.components = static_cast<int>(r.size("components"));
      field.unit = file.read_text_attribute(path, "unit");
      field.transport = transport_of(file.read_text_attribute(path, "transport"), file.path());
      field.description = file.read_text_attribute(path, "description");
      found.emplace_back(file.read_int_attribute(path, "index"), std::move(field));
    }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<mesh::Field> fields;
  for (auto& [index, field] : found) fields.push_back(std::move(field));
  return fields;
}

}  // namespace

void write_state(const std::string& path, const mesh::Snapshot& snapshot) {
  write_state(path, snapshot, mesh::reader_of(snapshot));
}

void write_state(const std::string& path, const mesh::Snapshot& outline,
                 const mesh::FieldReader& read) {
  const std::string part = core::part_path(path);
  core::require_room(path, room_for(outline));  // HDF5 crashes on a full disk
  auto file = hdf5::File::create(part, header_size);
  try {
    write_all(file, outline, read);
    file.close();
    seal(part);
  } catch (...) {
    file.abandon();
    std::remove(part.c_str());
    throw;
  }
  core::publish_part(path);
}

void verify_state(const std::string& path) { verify_seal(path); }

mesh::Snapshot read_state(const std::string& path) {
  if (holds_orientations_only(path))
    throw core::InputError(path + ": holds orientations without a mesh (polyslip taylor)");
  const auto file = hdf5::File::open(path);
  TableReader r(file);
  mesh::Snapshot s;
  s.time = r.get_scalar<double>("time");
  s.strain = r.get_scalar<double>("strain");
  s.mesh_number = r.get_scalar<std::int32_t>("mesh/number");
  s.quadrature_points = r.get_scalar<std::int32_t>("quadrature_points");
  s.mesh = read_mesh(r, path);
  s.fields = read_fields(file, r, s.quadrature_points);
  for (const auto& name : file.names("history")) {
    r.forget_size("values");
    s.history[name] = r.get<double>("history/" + name);
  }
  for (const auto& name : file.names("provenance"))
    s.provenance[name] = file.read_text("provenance/" + name);
  return s;
}

}  // namespace polyslip::results
