#include "drivers/mesh_files.hpp"

#include "core/error.hpp"
#include "results/names.hpp"

namespace polyslip::drivers {

void write_mesh_files(const mesh::Mesh& mesh, const std::string& folder, int number,
                      const std::vector<std::string>& formats, const mesh::GrainNotes& notes) {
  for (const std::string& name : formats) {
    const auto format = mesh::mesh_format(name);
    if (!format) throw core::InternalError("mesh format " + name);
    mesh::write_mesh(
        mesh, results::in_folder(folder, results::mesh_name(number, mesh::file_extension(*format))),
        *format, notes);
  }
}

}  // namespace polyslip::drivers
