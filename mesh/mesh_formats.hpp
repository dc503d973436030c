#pragma once
// The formats that meshes are written in.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

enum class MeshFormat { msh2, msh2_binary, msh4, msh4_binary, vtu, inp };

/// What a file may say of grains beside their elements. Empty, or one a cell.
struct GrainNotes {
  std::span<const core::Quaternion> orientations;
  std::span<const int> ids;  ///< their numbers in the file, positive; else 1, 2, ...

  int id(int cell) const { return ids.empty() ? cell + 1 : ids[static_cast<std::size_t>(cell)]; }
  /// Throws InternalError unless the spans are empty or have `cells` entries.
  void check(int cells) const;
};

/// "msh", "msh-binary", "msh4", "msh4-binary", "vtu", "inp", in the order of the enumeration.
const std::vector<std::string>& mesh_format_names();
std::optional<MeshFormat> mesh_format(const std::string& name);
/// ".msh", ".vtu" or ".inp".
std::string file_extension(MeshFormat format);

/// Writes in one of the formats, beside and renamed; InputError if that fails.
void write_mesh(const Mesh& mesh, const std::string& path, MeshFormat format,
                const GrainNotes& notes = {});

}  // namespace polyslip::mesh
