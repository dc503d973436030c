#include "drivers/convert_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "mesh/mesh_formats.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/tess_reader.hpp"
#include "mesh/tess_writer.hpp"
#include "mesh/tessellation_of_mesh.hpp"
#include "mesh/vtu_writer.hpp"

namespace polyslip::drivers {
namespace {

namespace fs = std::filesystem;
using core::Vec3;

std::string extension(std::string path) {
  if (path.ends_with(".gz")) path.erase(path.size() - 3);
  return fs::path(path).extension().string();
}

/// The format of the output: asked for, or told by its extension.
std::string format_of(const std::string& out, const std::string& asked) {
  const std::string known = fmt::format("{}, tess", fmt::join(mesh::mesh_format_names(), ", "));
  const std::string format = asked.empty() ? fs::path(out).extension().string() : "." + asked;
  const std::string name = format.empty() ? "" : format.substr(1);
  if (name != "tess" && !mesh::mesh_format(name))
    throw core::InputError(
        asked.empty()
            ? fmt::format("{}: its extension tells no format; name one of {} with --format", out,
                          known)
            : fmt::format("--format {}: must be one of {}", asked, known));
  return name;
}

void check_target(const std::string& out, bool overwrite) {
  if (fs::is_directory(out)) throw core::InputError(out + ": is a folder; give the name of a file");
  if (!overwrite && fs::exists(out))
    throw core::InputError(out + ": is there; give another name, or replace it with --overwrite");
}

/// Back to the coordinates of the file.
void restore(std::vector<Vec3>& points, const Vec3& origin, double scale) {
  for (Vec3& x : points) x = x / scale + origin;
}

void restore(mesh::Tessellation& t, const Vec3& origin, double scale) {
  restore(t.vertices, origin, scale);
  restore(t.seeds, origin, scale);
  restore(t.domain.vertices, origin, scale);
  for (mesh::Plane& p : t.face_planes) p.offset = p.offset / scale + p.normal.dot(origin);
  for (mesh::DomainFace& f : t.domain.faces)
    f.plane.offset = f.plane.offset / scale + f.plane.normal.dot(origin);
}

template <class T>
std::span<const T> given(const std::optional<std::vector<T>>& list) {
  return list ? std::span<const T>(*list) : std::span<const T>();
}

std::string tessellation_text(const mesh::Tessellation& t) {
  return fmt::format("{} cells, {} faces", t.topology.cell_count(), t.topology.faces.size());
}

std::string convert_tessellation(const std::string& in, const std::string& out,
                                 const std::string& format) {
  if (format != "tess" && format != "vtu")
    throw core::InputError(
        fmt::format("{}: a tessellation has no mesh to write as {}; `polyslip mesh` makes one of a "
                    "deck with [polycrystal] file = \"{}\"",
                    in, format, in));
  mesh::TessellationFile file = mesh::read_tess(in, mesh::LengthUnit::file);
  restore(file.tessellation, file.origin, file.scale);
  const std::string text = tessellation_text(file.tessellation);
  if (format == "vtu")
    mesh::write_vtu(file.tessellation, out,
                    {.orientations = given(file.orientations), .ids = file.cell_ids});
  else
    mesh::write_tess(file.tessellation, out,
                     {.orientations = given(file.orientations),
                      .ids = file.cell_ids,
                      .seed_weights = file.seed_weights,
                      .groups = given(file.groups),
                      .crystal = file.crystal.value_or("")});
  return text;
}

std::string convert_mesh(const std::string& in, const std::string& out, const std::string& format) {
  mesh::MeshFile file = mesh::read_msh(in, mesh::LengthUnit::file);
  if (format == "tess") {
    mesh::Tessellation t = mesh::tessellation_of(file.mesh, in);
    restore(t, file.origin, file.scale);
    mesh::write_tess(t, out,
                     {.orientations = given(file.orientations),
                      .ids = file.grain_ids,
                      .seed_weights = {},
                      .groups = {},
                      .crystal = ""});
    return tessellation_text(t);
  }
  restore(file.mesh.nodes, file.origin, file.scale);
  mesh::write_mesh(file.mesh, out, *mesh::mesh_format(format),
                   {.orientations = given(file.orientations), .ids = file.grain_ids});
  return fmt::format("{} grains, {} elements, {} nodes", file.mesh.topology.cell_count(),
                     file.mesh.element_count(), file.mesh.node_count());
}

}  // namespace

std::string convert_file(const std::string& in, const std::string& out, const std::string& format,
                         bool overwrite) {
  if (!fs::exists(in)) throw core::InputError(in + ": no such file");
  const std::string name = format_of(out, format), from = extension(in);
  if (from != ".tess" && from != ".msh")
    throw core::InputError(in + ": must be a tessellation (.tess) or a mesh (.msh); .gz too");
  check_target(out, overwrite);
  const std::string what =
      from == ".tess" ? convert_tessellation(in, out, name) : convert_mesh(in, out, name);
  return fmt::format("{}: {} ({})", out, what, name);
}

}  // namespace polyslip::drivers
