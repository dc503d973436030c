#include "mesh/mesh_formats.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "mesh/inp_writer.hpp"
#include "mesh/msh_writer.hpp"
#include "mesh/vtu_writer.hpp"

namespace polyslip::mesh {

void GrainNotes::check(int cells) const {
  const auto fits = [&](std::size_t size) {
    return size == 0 || size == static_cast<std::size_t>(cells);
  };
  if (!fits(orientations.size()) || !fits(ids.size()))
    throw core::InternalError(fmt::format("{} orientations and {} ids of {} grains",
                                          orientations.size(), ids.size(), cells));
}

const std::vector<std::string>& mesh_format_names() {
  static const std::vector<std::string> names{"msh",         "msh-binary", "msh4",
                                              "msh4-binary", "vtu",        "inp"};
  return names;
}

std::optional<MeshFormat> mesh_format(const std::string& name) {
  const auto& names = mesh_format_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return {};
  return static_cast<MeshFormat>(found - names.begin());
}

std::string file_extension(MeshFormat format) {
  if (format == MeshFormat::vtu) return ".vtu";
  return format == MeshFormat::inp ? ".inp" : ".msh";
}

void write_mesh(const Mesh& mesh, const std::string& path, MeshFormat format,
                const GrainNotes& notes) {
  notes.check(mesh.topology.cell_count());
  switch (format) {
    case MeshFormat::vtu:
      return write_vtu(mesh, path, notes);
    case MeshFormat::inp:
      return write_inp(mesh, path, notes);
    default:
      write_msh(mesh, path,
                {.newest = format == MeshFormat::msh4 || format == MeshFormat::msh4_binary,
                 .binary = format == MeshFormat::msh2_binary || format == MeshFormat::msh4_binary},
                notes);
  }
}

}  // namespace polyslip::mesh
