#pragma once

namespace polyslip::mesh {

/// The unit of the lengths of what is read: grains of unit mean volume, or the file's own.
enum class LengthUnit { grain, file };

}  // namespace polyslip::mesh
