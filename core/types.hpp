#pragma once
// Names for the fixed-size types that every folder uses.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace polyslip::core {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
/// Deviatoric symmetric tensor in the orthonormal basis of core/tensor.hpp.
using Vec5 = Eigen::Matrix<double, 5, 1>;
/// Symmetric tensor in Mandel order xx yy zz yz zx xy (shear times sqrt 2).
using Vec6 = Eigen::Matrix<double, 6, 1>;
/// Unit quaternion of a crystal orientation: its matrix turns crystal axes into sample axes
/// (its columns are the crystal axes in the sample frame; v_sample = Q v_crystal).
using Quaternion = Eigen::Quaterniond;

}  // namespace polyslip::core
