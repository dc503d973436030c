#include "mesh/orientation_block.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/file.hpp"
#include "core/rotation.hpp"

namespace polyslip::mesh {
namespace {

using core::Quaternion;
using core::Vec3;

struct Name {
  const char* text;
  OrientationKind kind;
  int numbers;
};
constexpr std::array<Name, 7> names{{{"rodrigues", OrientationKind::rodrigues, 3},
                                     {"quaternion", OrientationKind::quaternion, 4},
                                     {"axis-angle", OrientationKind::axis_angle, 4},
                                     {"euler-bunge", OrientationKind::bunge, 3},
                                     {"euler-kocks", OrientationKind::kocks, 3},
                                     {"euler-roe", OrientationKind::roe, 3},
                                     {"rotmat", OrientationKind::matrix, 9}}};

// Files hold numbers of a few digits.
constexpr double tolerance = 1e-3;

/// As it stands if it is a unit quaternion already, so that what we wrote comes back bit for bit.
Quaternion unit(TextScanner& in, const Quaternion& q) {
  const double length = q.norm();
  if (!(std::abs(length - 1) <= tolerance))
    in.fail(fmt::format("a quaternion of length {:.6g}, not 1", length));
  return std::abs(length - 1) < 1e-15 ? q : q.normalized();
}

Quaternion axis_angle(TextScanner& in, const std::array<double, 9>& x) {
  const Vec3 axis(x[0], x[1], x[2]);
  if (!(axis.norm() > 0)) in.fail("an axis of rotation without a direction");
  return core::exp_axial(axis.normalized() * (x[3] / core::degrees_per_radian));
}

Quaternion matrix(TextScanner& in, const std::array<double, 9>& x) {
  core::Mat3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = x[i];
  if (!((m * m.transpose() - core::Mat3::Identity()).norm() <= tolerance) || !(m.determinant() > 0))
    in.fail("a matrix that is no rotation");
  return core::from_matrix(m.transpose());
}

Quaternion rotation(TextScanner& in, OrientationKind kind, const std::array<double, 9>& x) {
  switch (kind) {
    case OrientationKind::rodrigues:
      return core::from_rodrigues({x[0], x[1], x[2]});
    case OrientationKind::quaternion:
      return unit(in, Quaternion(x[0], x[1], x[2], x[3]));
    case OrientationKind::axis_angle:
      return axis_angle(in, x);
    case OrientationKind::bunge:
      return core::from_bunge({x[0], x[1], x[2]});
    case OrientationKind::kocks:
      return core::from_bunge({x[0] + 90, x[1], 90 - x[2]});
    case OrientationKind::roe:
      return core::from_bunge({x[0] + 90, x[1], x[2] - 90});
    case OrientationKind::matrix:
      break;
  }
  return matrix(in, x);
}

}  // namespace

OrientationDescriptor read_orientation_descriptor(TextScanner& in) {
  const std::string text(in.word("the descriptor of the orientations"));
  const auto colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string convention = colon == std::string::npos ? "active" : text.substr(colon + 1);
  std::string known;
  for (const Name& name : names) {
    if (kind == name.text && (convention == "active" || convention == "passive"))
      return {name.kind, convention == "passive"};
    known += fmt::format("{}{}", known.empty() ? "" : ", ", name.text);
  }
  in.fail(fmt::format("orientations are '{}'; read are {}, each with :active or :passive", text,
                      known));
}

Quaternion read_orientation(TextScanner& in, const OrientationDescriptor& descriptor) {
  std::array<double, 9> x{};
  for (const Name& name : names)
    if (name.kind == descriptor.kind)
      for (int i = 0; i < name.numbers; ++i) x[i] = in.number("a number of an orientation");
  const Quaternion d = rotation(in, descriptor.kind, x);
  return descriptor.passive ? d : d.conjugate();
}

void put_orientation(core::FileWriter& out, const Quaternion& orientation) {
  for (const double x : {orientation.w(), orientation.x(), orientation.y(), orientation.z()}) {
    out.put(' ');
    out.put(x);
  }
}

}  // namespace polyslip::mesh
