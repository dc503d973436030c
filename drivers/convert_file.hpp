#pragma once
// `polyslip convert IN OUT`: tessellations and meshes from one format to another.

#include <string>

namespace polyslip::drivers {

/// Reads `in`, a tessellation (.tess) or a mesh (.msh; both .gz too), and writes `out`. What is
/// written follows `format`, one of mesh::mesh_format_names() or "tess", or if that is empty the
/// extension of `out` (.msh: Gmsh's 2.2, ASCII). Positions, numbers of grains and orientations stay
/// those of the file. A mesh may be asked for as a tessellation if the edges of its grains are
/// straight. Returns a line that says what was done. InputError for files that cannot be read or
/// written, formats that are not known or do not fit, and an `out` that is there already unless
/// `overwrite`.
std::string convert_file(const std::string& in, const std::string& out, const std::string& format,
                         bool overwrite);

}  // namespace polyslip::drivers
