#pragma once
// Pictures of polycrystals, coloured by orientation.

#include <span>
#include <string>

#include "mesh/snapshot.hpp"

namespace polyslip::results {

struct PictureOptions {
  int width = 1800;       ///< pixels
  double azimuth = 28;    ///< degrees the eye is turned from -y (TD) towards +x (RD)
  double elevation = 24;  ///< degrees of the eye above the x-y plane
};

/// Writes a PNG: both domain surfaces in parallel projection at one scale, x (RD) to the right,
/// y (TD) into the page, z (ND) up. Each boundary triangle has the colour of its element's mean
/// orientation by the formula under the paper's fig. 17, slightly shaded; grain boundaries are
/// dark, element edges light. InputError if the file cannot be written.
void write_picture(const std::string& path, const mesh::Snapshot& undeformed,
                   const mesh::Snapshot& deformed, const PictureOptions& options = {});

/// Writes a PNG of one mesh, each grain in the colour of its orientation ([grains]), otherwise as
/// above; `options.width` is that of the picture.
void write_mesh_picture(const std::string& path, const mesh::Mesh& mesh,
                        std::span<const core::Quaternion> orientations,
                        const PictureOptions& options = {});

}  // namespace polyslip::results
