#include "mesh/vtu_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string_view>

#include "core/file.hpp"
#include "mesh/face_fan.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

/// VTK's numbers of cell types.
constexpr std::uint8_t vtk_tetra = 10, vtk_quadratic_tetra = 24, vtk_polyhedron = 42;

/// An unstructured grid whose arrays follow its description, each produced as it is written.
class VtuFile {
 public:
  explicit VtuFile(const std::string& path) : out_(path) {}

  /// `produce` puts `bytes` bytes in all.
  void add(const char* place, const std::string& name, const char* type, int components,
           std::uint64_t bytes, std::function<void()> produce) {
    arrays_.push_back({place, name, type, components, bytes, std::move(produce)});
  }

  template <class T>
  void put(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out_.put(std::string_view(bytes, sizeof(T)));
  }

  void write(std::size_t points, std::size_t cells) {
    out_.put(fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"{}\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", points, cells));
    std::uint64_t offset = 0;
    for (const char* place : {"Points", "Cells", "CellData"}) {
      out_.put(fmt::format("<{}>\n", place));
      for (Array& array : arrays_) {
        if (std::string_view(array.place) != place) continue;
        out_.put(
            fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
                        "format=\"appended\" offset=\"{}\"/>\n",
                        array.type, array.name, array.components, offset));
        offset += sizeof(std::uint64_t) + array.bytes;
      }
      out_.put(fmt::format("</{}>\n", place));
    }
    out_.put("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    for (const char* place : {"Points", "Cells", "CellData"})
      for (Array& array : arrays_) {
        if (std::string_view(array.place) != place) continue;
        put<std::uint64_t>(array.bytes);
        array.produce();
      }
    out_.put("\n</AppendedData>\n</VTKFile>\n");
    out_.finish();
  }

 private:
  struct Array {
    const char* place;
    std::string name;
    const char* type;
    int components;
    std::uint64_t bytes;
    std::function<void()> produce;
  };

  core::FileWriter out_;
  std::vector<Array> arrays_;
};

void add_points(VtuFile& file, const std::vector<Vec3>& points) {
  file.add("Points", "Points", "Float64", 3, points.size() * 24, [&] {
    for (const Vec3& x : points)
      for (int i = 0; i < 3; ++i) file.put(x[i]);
  });
}

/// An array of one number a cell.
template <class T, class Value>
void add_cells(VtuFile& file, const char* place, const char* name, const char* type,
               std::size_t cells, Value value) {
  file.add(place, name, type, 1, cells * sizeof(T), [&file, cells, value] {
    for (std::size_t c = 0; c < cells; ++c) file.put<T>(value(c));
  });
}

/// `grain_of`: the cell of the polycrystal that a cell of the grid belongs to.
template <class GrainOf>
void add_orientations(VtuFile& file, const GrainNotes& notes, std::size_t cells, GrainOf grain_of) {
  if (notes.orientations.empty()) return;
  file.add("CellData", "orientation", "Float64", 4, cells * 32, [&file, &notes, cells, grain_of] {
    for (std::size_t c = 0; c < cells; ++c) {
      const core::Quaternion& q = notes.orientations[grain_of(c)];
      for (const double x : {q.w(), q.x(), q.y(), q.z()}) file.put(x);
    }
  });
}

/// Polyhedra of a tessellation as VTK wants them.
struct Polyhedra {
  std::vector<Vec3> points;
  std::vector<std::int32_t> connectivity, faces;
  std::vector<std::int64_t> offsets, face_offsets;
};

/// The polygons of a face, as numbers of points: one, or its interpolation triangles, for which the
/// barycentre may be a new point.
std::vector<std::vector<int>> polygons(const Tessellation& t, int face, std::vector<Vec3>& points) {
  // Well below what can be seen, well above what rounding does.
  constexpr double flat = 1e-9;
  const auto loop = t.topology.face_vertices(face);
  std::vector<Vec3> positions;
  for (const int v : loop) positions.push_back(t.vertices[v]);
  const Vec3 normal = vector_area(positions).normalized();
  if (std::all_of(positions.begin(), positions.end(),
                  [&](const Vec3& x) { return std::abs(normal.dot(x - positions[0])) <= flat; }))
    return {loop};
  const int master = t.face_masters[face], n = static_cast<int>(loop.size());
  int centre = master >= 0 ? loop[master] : static_cast<int>(points.size());
  if (master < 0) points.push_back(fan_master(positions, master));
  std::vector<std::vector<int>> triangles;
  for (int i = 0; i < n; ++i)
    if (const int j = (i + 1) % n; i != master && j != master)
      triangles.push_back({loop[i], loop[j], centre});
  return triangles;
}

Polyhedra polyhedra_of(const Tessellation& t) {
  Polyhedra p;
  p.points = t.vertices;
  std::vector<std::vector<std::vector<int>>> face_polygons;
  for (int f = 0; f < static_cast<int>(t.topology.faces.size()); ++f)
    face_polygons.push_back(polygons(t, f, p.points));
  for (int c = 0; c < t.topology.cell_count(); ++c) {
    std::vector<int> corners;
    const std::size_t count_at = p.faces.size();
    p.faces.push_back(0);
    for (const int f : t.topology.cell_faces[c])
      for (const auto& polygon : face_polygons[f]) {
        ++p.faces[count_at];
        p.faces.push_back(static_cast<std::int32_t>(polygon.size()));
        // Outwards, as VTK asks.
        if (t.topology.faces[f].cells[0] == c)
          p.faces.insert(p.faces.end(), polygon.begin(), polygon.end());
        else
          p.faces.insert(p.faces.end(), polygon.rbegin(), polygon.rend());
        corners.insert(corners.end(), polygon.begin(), polygon.end());
      }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    p.connectivity.insert(p.connectivity.end(), corners.begin(), corners.end());
    p.offsets.push_back(static_cast<std::int64_t>(p.connectivity.size()));
    p.face_offsets.push_back(static_cast<std::int64_t>(p.faces.size()));
  }
  return p;
}

template <class T>
void add_list(VtuFile& file, const char* name, const char* type, const std::vector<T>& list) {
  file.add("Cells", name, type, 1, list.size() * sizeof(T), [&] {
    for (const T x : list) file.put(x);
  });
}

}  // namespace

void write_vtu(const Mesh& mesh, const std::string& path, const GrainNotes& notes) {
  notes.check(mesh.topology.cell_count());
  const std::size_t cells = mesh.tetrahedra.size(), corners = mesh.order == 2 ? 10 : 4;
  VtuFile file(path);
  add_points(file, mesh.nodes);
  file.add("Cells", "connectivity", "Int32", 1, cells * corners * 4, [&] {
    constexpr std::array<int, 10> order{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
    for (const auto& t : mesh.tetrahedra)
      for (std::size_t i = 0; i < corners; ++i) file.put<std::int32_t>(t[order[i]]);
  });
  add_cells<std::int64_t>(file, "Cells", "offsets", "Int64", cells,
                          [&](std::size_t c) { return (c + 1) * corners; });
  add_cells<std::uint8_t>(file, "Cells", "types", "UInt8", cells, [&](std::size_t) {
    return mesh.order == 2 ? vtk_quadratic_tetra : vtk_tetra;
  });
  add_cells<std::int32_t>(file, "CellData", "grain", "Int32", cells,
                          [&](std::size_t c) { return notes.id(mesh.tetrahedron_cell[c]); });
  add_cells<double>(file, "CellData", "radius_ratio", "Float64", cells, [&](std::size_t c) {
    const auto& t = mesh.tetrahedra[c];
    return radius_ratio(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]);
  });
  add_orientations(file, notes, cells, [&](std::size_t c) { return mesh.tetrahedron_cell[c]; });
  file.write(mesh.nodes.size(), cells);
}

void write_vtu(const Tessellation& tessellation, const std::string& path, const GrainNotes& notes) {
  const int count = tessellation.topology.cell_count();
  notes.check(count);
  const auto cells = static_cast<std::size_t>(count);
  const Polyhedra p = polyhedra_of(tessellation);
  VtuFile file(path);
  add_points(file, p.points);
  add_list(file, "connectivity", "Int32", p.connectivity);
  add_list(file, "offsets", "Int64", p.offsets);
  add_cells<std::uint8_t>(file, "Cells", "types", "UInt8", cells,
                          [](std::size_t) { return vtk_polyhedron; });
  add_list(file, "faces", "Int32", p.faces);
  add_list(file, "faceoffsets", "Int64", p.face_offsets);
  add_cells<std::int32_t>(file, "CellData", "grain", "Int32", cells,
                          [&](std::size_t c) { return notes.id(static_cast<int>(c)); });
  add_cells<double>(file, "CellData", "volume", "Float64", cells,
                    [&](std::size_t c) { return cell_volume(tessellation, static_cast<int>(c)); });
  add_cells<std::int32_t>(file, "CellData", "face_count", "Int32", cells, [&](std::size_t c) {
    return static_cast<std::int32_t>(tessellation.topology.cell_faces[c].size());
  });
  add_orientations(file, notes, cells, [](std::size_t c) { return c; });
  file.write(p.points.size(), cells);
}

}  // namespace polyslip::mesh
