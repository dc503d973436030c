#pragma once
// A stored state as a table: one row an element.

#include <string>

#include "results/element_values.hpp"
#include "results/xdmf.hpp"

namespace polyslip::results {

inline const std::string element_header =
    "element,grain,x,y,z,volume,q0,q1,q2,q3,g,slip,equivalent_strain,sxx,syy,szz,syz,szx,sxy,"
    "pressure";

/// Writes `csv` from the stored state nearest to `strain` in the run folder and returns which it
/// was. Rows in the order of the mesh file (mesh-NNN.msh of the state's mesh number), element and
/// grain from 1, quaternion w x y z that turns crystal axes into sample axes, MPa; numbers in the
/// shortest form that reads back to the same double. Of a Taylor model a row is an orientation,
/// which has no place (NaN) and counts as a grain of volume 1. InputError if the folder holds no
/// stored state, the state is damaged, the table cannot be written, or `csv` is there, is no such
/// table, and `overwrite` is false.
StateRecord convert(const std::string& run_folder, double strain, const std::string& csv,
                    ElementValue value, bool overwrite = false);

}  // namespace polyslip::results
