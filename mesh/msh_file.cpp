// Gmsh's formats 2.2 and 4.1, ASCII and binary.

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/file.hpp"
#include "mesh/msh_periodic.hpp"
#include "mesh/msh_writer.hpp"
#include "mesh/orientation_block.hpp"

namespace polyslip::mesh {
namespace {

/// Gmsh's element types: 4 and 11 tetrahedra of order 1 and 2, 2 and 9 triangles.
constexpr int tetrahedron_type(int order) { return order == 2 ? 11 : 4; }
constexpr int triangle_type(int order) { return order == 2 ? 9 : 2; }

class MshWriter {
 public:
  MshWriter(const Mesh& mesh, const std::string& path, const MshOptions& format,
            const GrainNotes& notes)
      : mesh_(mesh),
        format_(format),
        notes_(notes),
        surfaces_(mesh.domain.surface_of_face()),
        out_(path) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      if (mesh.topology.faces[mesh.triangle_face[i]].cells[1] < 0)
        surface_.push_back(static_cast<int>(i));
  }

  void write() {
    out_.put(
        fmt::format("$MeshFormat\n{} {:d} 8\n", format_.newest ? "4.1" : "2.2", format_.binary));
    if (format_.binary) {
      raw<std::int32_t>(1);
      out_.put('\n');
    }
    out_.put("$EndMeshFormat\n");
    names();
    if (format_.newest) entities();
    nodes();
    format_.newest ? elements_41() : elements_22();
    if (!mesh_.topology.periodic.empty()) periodic();
    if (!notes_.orientations.empty()) put_orientations();
    out_.finish();
  }

 private:
  int domain_face(std::size_t triangle) const {
    return mesh_.topology.faces[mesh_.triangle_face[triangle]].domain_face;
  }
  /// 0, none, for periodic faces.
  int physical_surface(int triangle) const {
    const int face = domain_face(triangle);
    return face < 0 ? 0 : surfaces_[face] + 1;
  }

  template <class T>
  void raw(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out_.put(std::string_view(bytes, sizeof(T)));
  }

  /// A number of a row: four bytes in a binary file.
  void number(int value) {
    if (format_.binary) return raw<std::int32_t>(value);
    gap();
    out_.put(value);
  }
  /// One of format 4.1's counts and tags, eight bytes.
  void wide(std::size_t value) {
    if (format_.binary) return raw<std::uint64_t>(value);
    gap();
    out_.put(value);
  }
  void real(double value) {
    if (format_.binary) return raw(value);
    gap();
    out_.put(value);
  }
  void gap() {
    if (inside_row_) out_.put(' ');
    inside_row_ = true;
  }
  /// The end of a row, which binary files do without.
  void end() {
    if (!format_.binary) out_.put('\n');
    inside_row_ = false;
  }
  /// The end of a section's numbers.
  void close(const char* section) {
    if (format_.binary) out_.put('\n');
    out_.put(section);
    out_.put('\n');
  }

  void names() {
    const auto surfaces = mesh_.domain.surface_names();
    out_.put(
        fmt::format("$PhysicalNames\n{}\n", surfaces.size() + mesh_.topology.cell_faces.size()));
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      out_.put(fmt::format("2 {} \"{}\"\n", i + 1, surfaces[i]));
    for (int c = 0; c < mesh_.topology.cell_count(); ++c)
      out_.put(fmt::format("3 {0} \"grain{0}\"\n", notes_.id(c)));
    out_.put("$EndPhysicalNames\n");
  }

  /// One row of $Entities; what bounds it is not told.
  void entity(int tag, const Eigen::AlignedBox3d& box, int physical) {
    number(tag);
    for (int i = 0; i < 3; ++i) real(box.min()[i]);
    for (int i = 0; i < 3; ++i) real(box.max()[i]);
    wide(physical > 0 ? 1 : 0);
    if (physical > 0) number(physical);
    wide(0);
    end();
  }

  void entities() {
    struct Entity {
      int tag, physical;
      Eigen::AlignedBox3d box;
    };
    std::vector<Entity> faces, grains;
    for (const int t : surface_) {
      const int face = mesh_.triangle_face[t];
      if (faces.empty() || faces.back().tag != face + 1)
        faces.push_back({face + 1, physical_surface(t), {}});
      for (int i = 0; i < 3; ++i) faces.back().box.extend(mesh_.nodes[mesh_.triangles[t][i]]);
    }
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const int grain = notes_.id(mesh_.tetrahedron_cell[e]);
      if (grains.empty() || grains.back().tag != grain) grains.push_back({grain, grain, {}});
      for (int i = 0; i < 4; ++i) grains.back().box.extend(mesh_.nodes[mesh_.tetrahedra[e][i]]);
    }
    out_.put("$Entities\n");
    for (const std::size_t count : {std::size_t{0}, std::size_t{0}, faces.size(), grains.size()})
      wide(count);
    end();
    for (const auto* list : {&faces, &grains})
      for (const Entity& e : *list) entity(e.tag, e.box, e.physical);
    close("$EndEntities");
  }

  void position(const core::Vec3& x) {
    for (int i = 0; i < 3; ++i) real(x[i]);
  }

  void nodes() {
    const std::size_t count = mesh_.nodes.size();
    out_.put("$Nodes\n");
    if (!format_.newest) {
      out_.put(fmt::format("{}\n", count));
      for (std::size_t i = 0; i < count; ++i) {
        number(static_cast<int>(i) + 1);
        position(mesh_.nodes[i]);
        end();
      }
      return close("$EndNodes");
    }
    // All in one block, of the first grain: which entity a node lies in says nothing here.
    for (const std::size_t n : {std::size_t{1}, count, std::size_t{1}, count}) wide(n);
    end();
    number(3);
    number(1);
    number(0);
    wide(count);
    end();
    for (std::size_t i = 0; i < count; ++i) {
      wide(i + 1);
      end();
    }
    for (const core::Vec3& x : mesh_.nodes) {
      position(x);
      end();
    }
    close("$EndNodes");
  }

  template <std::size_t N>
  void row_22(int id, int type, int physical, int elementary, const std::array<int, N>& nodes) {
    number(id);
    if (!format_.binary) {
      number(type);
      number(2);
    }
    number(physical);
    number(elementary);
    for (const int n : nodes)
      if (n >= 0) number(n + 1);
    end();
  }

  /// The heading of the elements of a type, in a binary file.
  void heading_22(int type, std::size_t count) {
    if (!format_.binary || count == 0) return;
    number(type);
    number(static_cast<int>(count));
    number(2);
  }

  void elements_22() {
    out_.put(fmt::format("$Elements\n{}\n", mesh_.tetrahedra.size() + surface_.size()));
    int id = 0;
    heading_22(tetrahedron_type(mesh_.order), mesh_.tetrahedra.size());
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const int grain = notes_.id(mesh_.tetrahedron_cell[e]);
      row_22(++id, tetrahedron_type(mesh_.order), grain, grain, mesh_.tetrahedra[e]);
    }
    heading_22(triangle_type(mesh_.order), surface_.size());
    for (const int t : surface_)
      row_22(++id, triangle_type(mesh_.order), physical_surface(t), mesh_.triangle_face[t] + 1,
             mesh_.triangles[t]);
    close("$EndElements");
  }

  /// Calls visit(entity, first, last) for each run of equal numbers in `entities`.
  template <class Visit>
  static void for_each_run(std::size_t count, const auto& entity_of, Visit&& visit) {
    for (std::size_t first = 0; first < count;) {
      std::size_t last = first + 1;
      while (last < count && entity_of(last) == entity_of(first)) ++last;
      visit(entity_of(first), first, last);
      first = last;
    }
  }

  template <std::size_t N>
  void row_41(std::size_t id, const std::array<int, N>& nodes) {
    wide(id);
    for (const int n : nodes)
      if (n >= 0) wide(static_cast<std::size_t>(n) + 1);
    end();
  }

  void heading_41(int dimension, int entity, int type, std::size_t count) {
    number(dimension);
    number(entity);
    number(type);
    wide(count);
    end();
  }

  void elements_41() {
    const auto grain = [&](std::size_t e) { return notes_.id(mesh_.tetrahedron_cell[e]); };
    const auto face = [&](std::size_t i) { return mesh_.triangle_face[surface_[i]] + 1; };
    const std::size_t elements = mesh_.tetrahedra.size(), count = elements + surface_.size();
    std::size_t blocks = 0;
    const auto count_block = [&](int, std::size_t, std::size_t) { ++blocks; };
    for_each_run(elements, grain, count_block);
    for_each_run(surface_.size(), face, count_block);
    out_.put("$Elements\n");
    for (const std::size_t n : {blocks, count, std::size_t{1}, count}) wide(n);
    end();
    for_each_run(elements, grain, [&](int tag, std::size_t first, std::size_t last) {
      heading_41(3, tag, tetrahedron_type(mesh_.order), last - first);
      for (std::size_t e = first; e < last; ++e) row_41(e + 1, mesh_.tetrahedra[e]);
    });
    for_each_run(surface_.size(), face, [&](int tag, std::size_t first, std::size_t last) {
      heading_41(2, tag, triangle_type(mesh_.order), last - first);
      for (std::size_t i = first; i < last; ++i)
        row_41(elements + i + 1, mesh_.triangles[surface_[i]]);
    });
    close("$EndElements");
  }

  /// Format 2.2 has this section as text in binary files too.
  void periodic() {
    const auto links = periodic_links(mesh_);
    out_.put("$Periodic\n");
    if (!format_.newest) return periodic_22(links);
    wide(links.size());
    end();
    for (const auto& link : links) {
      for (const int n : {2, link.slave + 1, link.master + 1}) number(n);
      end();
      wide(16);
      for (const double a : affine(link.translation)) real(a);
      end();
      wide(link.nodes.size());
      end();
      for (const auto& [slave, master] : link.nodes) {
        wide(static_cast<std::size_t>(slave) + 1);
        wide(static_cast<std::size_t>(master) + 1);
        end();
      }
    }
    close("$EndPeriodic");
  }

  void periodic_22(const std::vector<PeriodicLink>& links) {
    out_.put(fmt::format("{}\n", links.size()));
    for (const auto& link : links) {
      out_.put(fmt::format("2 {} {}\nAffine", link.slave + 1, link.master + 1));
      for (const double a : affine(link.translation)) {
        out_.put(' ');
        out_.put(a);
      }
      out_.put(fmt::format("\n{}\n", link.nodes.size()));
      for (const auto& [slave, master] : link.nodes)
        out_.put(fmt::format("{} {}\n", slave + 1, master + 1));
    }
    out_.put("$EndPeriodic\n");
  }

  /// The matrix, row by row, of the motion from a master to its slave.
  static std::array<double, 16> affine(const core::Vec3& t) {
    return {1, 0, 0, t[0], 0, 1, 0, t[1], 0, 0, 1, t[2], 0, 0, 0, 1};
  }

  void put_orientations() {
    const auto& orientations = notes_.orientations;
    out_.put(fmt::format("$ElsetOrientations\n{} {}\n", orientations.size(), written_descriptor));
    for (std::size_t i = 0; i < orientations.size(); ++i) {
      out_.put(notes_.id(static_cast<int>(i)));
      put_orientation(out_, orientations[i]);
      out_.put('\n');
    }
    out_.put("$EndElsetOrientations\n");
  }

  const Mesh& mesh_;
  MshOptions format_;
  const GrainNotes& notes_;
  std::vector<int> surfaces_;  ///< [domain faces] physical surface, from 0
  core::FileWriter out_;
  bool inside_row_ = false;
  std::vector<int> surface_;  ///< triangles with a grain on one side
};

}  // namespace

void write_msh(const Mesh& mesh, const std::string& path, const MshOptions& options,
               const GrainNotes& notes) {
  notes.check(mesh.topology.cell_count());
  MshWriter(mesh, path, options, notes).write();
}

void write_msh(const Mesh& mesh, const std::string& path) { write_msh(mesh, path, {}); }

}  // namespace polyslip::mesh
