#include "solver/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "material/point_driver.hpp"

namespace polyslip::solver {
namespace {

bool on(std::uint8_t node_faces, int face) { return ((node_faces >> face) & 1u) != 0; }

std::function<double(double)> fixed(double at) {
  return [at](double) { return at; };
}

/// The face at the low (side 0) or high (1) end of an axis.
int face_of(int axis, int side) { return 2 * axis + side; }

std::uint8_t corner(const std::array<int, 3>& sides) {
  unsigned faces = 0;
  for (int i = 0; i < 3; ++i) faces |= 1u << face_of(i, sides[static_cast<std::size_t>(i)]);
  return static_cast<std::uint8_t>(faces);
}

/// Tension or compression along one axis, flat faces across it free of shear. The other axes are
/// free, or one of them is fixed.
class BoxLoad {
 public:
  BoxLoad(const LoadingOptions& loading, const core::Vec3& size, int stretch)
      : axis_(loading.axis), stretch_(stretch), size_(size) {
    boundary_.faces = {{face_of(axis_, 0), axis_, fixed(0)},
                       {face_of(axis_, 1), axis_, [h0 = size[axis_], stretch](double strain) {
                          return h0 * std::exp(stretch * strain);
                        }}};
  }

  void fix(int axis) {
    fixed_ = axis;
    boundary_.faces.push_back({face_of(axis, 0), axis, fixed(0)});
    boundary_.faces.push_back({face_of(axis, 1), axis, fixed(size_[axis])});
  }

  Boundary finish(const std::string& lateral) {
    std::vector<int> free;
    for (int i = 1; i <= 2; ++i)
      if ((axis_ + i) % 3 != fixed_) free.push_back((axis_ + i) % 3);
    if (lateral == "free")
      hold(free);
    else
      for (int axis : free) boundary_.faces.push_back({face_of(axis, 0), axis, fixed(0)});
    if (lateral == "planar")
      for (int axis : free) boundary_.planar.push_back({face_of(axis, 1), fixed(0)});
    boundary_.mean_gradient = [free, axis = axis_, s = stretch_](double strain) -> core::Mat3 {
      core::Vec3 stretch = core::Vec3::Ones();
      stretch[axis] = std::exp(s * strain);
      for (int i : free) stretch[i] = std::exp(-s * strain / static_cast<double>(free.size()));
      return stretch.asDiagonal();
    };
    return boundary_;
  }

 private:
  int axis_, stretch_, fixed_ = -1;
  core::Vec3 size_;
  Boundary boundary_;

  /// Three or one rigid motions are left: held at the low corner and, against rotation about the
  /// axis, at the corner next to it.
  void hold(const std::vector<int>& free) {
    std::array<int, 3> sides{};
    for (int i : free) boundary_.held.push_back({corner(sides), i});
    if (free.size() < 2) return;
    sides[static_cast<std::size_t>(free[0])] = 1;
    boundary_.held.push_back({corner(sides), free[1]});
  }
};

Boundary plane_strain_compression(const LoadingOptions& loading, const core::Vec3& size) {
  BoxLoad load(loading, size, -1);
  load.fix(loading.constrained_axis);
  return load.finish(loading.lateral);
}

Boundary uniaxial(const LoadingOptions& loading, const core::Vec3& size, int stretch) {
  return BoxLoad(loading, size, stretch).finish(loading.lateral);
}

Boundary homogeneous(std::function<core::Mat3(double)> gradient) {
  Boundary b;
  b.all = [gradient](const core::Vec3& x, double e) -> core::Vec3 { return gradient(e) * x; };
  b.mean_gradient = std::move(gradient);
  return b;
}

Boundary simple_shear(const LoadingOptions& loading) {
  return homogeneous([i = loading.direction, j = loading.axis](double shear) {
    core::Mat3 f = core::Mat3::Identity();
    f(i, j) = shear;
    return f;
  });
}

Boundary velocity_gradient(const LoadingOptions& loading) {
  const core::Mat3& l = loading.velocity_gradient;
  const core::Mat3 d = 0.5 * (l + l.transpose());
  const core::Mat3 unit = l / std::sqrt(2.0 / 3 * d.squaredNorm());
  return homogeneous([unit](double strain) { return material::exponential(unit * strain); });
}

/// Motion of the faces of type = "faces".
struct FaceMotions {
  LoadingOptions l;
  core::Vec3 size;

  const FaceCondition& condition(int face) const { return l.faces[static_cast<std::size_t>(face)]; }
  bool whole(int face) const {
    return condition(face).kind == "fixed" || condition(face).kind == "moving";
  }
  /// Whether the face's normal position is prescribed.
  bool prescribed(int face) const { return whole(face) || condition(face).kind == "sliding"; }
  double speed(int face, int component) const { return condition(face).velocity[component]; }

  /// Displacement of a face along its normal: v t, or so that the box is strained at a constant
  /// true rate, dh/dt = (v1 - v0) h/h0.
  double along_normal(int face, double strain) const {
    const int axis = face / 2;
    const double v = speed(face, axis), t = strain / l.strain_rate;
    const double rate = (speed(2 * axis + 1, axis) - speed(2 * axis, axis)) / size[axis];
    if (l.control == "constant-velocity" || rate == 0) return v * t;
    return v * std::expm1(rate * t) / rate;
  }

  core::Mat3 mean_gradient(double strain) const {
    core::Mat3 f = core::Mat3::Identity();
    std::vector<int> free;
    double volume = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const int low = 2 * axis, high = low + 1;
      if (!prescribed(low) || !prescribed(high)) {
        free.push_back(axis);
        continue;
      }
      f(axis, axis) += (along_normal(high, strain) - along_normal(low, strain)) / size[axis];
      volume *= f(axis, axis);
      for (int i = 0; whole(low) && whole(high) && i < 3; ++i)
        if (i != axis)
          f(i, axis) = (speed(high, i) - speed(low, i)) * strain / (l.strain_rate * size[axis]);
    }
    for (int axis : free)
      f(axis, axis) = std::pow(std::abs(volume), -1.0 / static_cast<double>(free.size()));
    return f;
  }
};

void add_normal(Boundary& boundary, const FaceMotions& motions, int face) {
  const int axis = face / 2;
  boundary.faces.push_back(
      {face, axis, [motions, face, at = face % 2 * motions.size[axis]](double e) {
         return at + motions.along_normal(face, e);
       }});
}

void add_tangential(Boundary& boundary, const FaceMotions& motions, int face) {
  for (int i = 0; i < 3; ++i) {
    if (i == face / 2) continue;
    const double per_strain = motions.speed(face, i) / motions.l.strain_rate;
    boundary.faces.push_back({face, i, [per_strain](double e) { return per_strain * e; }, true});
  }
}

/// On an edge a face that is prescribed in every component goes before one that slides.
Boundary faces(const LoadingOptions& loading, const core::Vec3& size) {
  const FaceMotions motions{loading, size};
  Boundary b;
  for (int face = 0; face < 6; ++face)
    if (motions.whole(face)) {
      add_normal(b, motions, face);
      add_tangential(b, motions, face);
    }
  for (int face = 0; face < 6; ++face) {
    const FaceCondition& c = motions.condition(face);
    if (c.kind == "sliding") add_normal(b, motions, face);
    if (c.kind == "planar")
      b.planar.push_back({face, [full = c.traction, over = loading.traction_strain](double path) {
                            return full * std::min(path / over, 1.0);
                          }});
  }
  for (const HeldCorner& c : loading.held)
    for (int i = 0; i < 3; ++i)
      if (c.components[static_cast<std::size_t>(i)]) b.held.push_back({corner(c.sides), i});
  b.mean_gradient = [motions](double strain) { return motions.mean_gradient(strain); };
  return b;
}

}  // namespace

bool Boundary::moves(std::uint8_t node_faces, int component) const {
  for (const auto& m : faces)
    if (m.component == component && on(node_faces, m.face)) return true;
  return false;
}

bool Boundary::constrains(std::uint8_t node_faces, int component) const {
  if (all) return node_faces != 0;
  if (moves(node_faces, component)) return true;
  for (const auto& h : held)
    if (h.component == component && h.faces == node_faces) return true;
  return planar_constrains(node_faces, component);
}

bool Boundary::face_constrains(int face, int component) const {
  if (all) return true;
  for (const auto& m : faces)
    if (m.component == component && m.face == face) return true;
  return planar_constrains(static_cast<std::uint8_t>(1u << face), component);
}

bool Boundary::planar_constrains(std::uint8_t node_faces, int component) const {
  if (all || moves(node_faces, component)) return false;
  for (const auto& p : planar)
    if (p.component() == component && on(node_faces, p.face)) return true;
  return false;
}

double Boundary::position(std::uint8_t node_faces, int component, const core::Vec3& initial,
                          double strain) const {
  if (all) return all(initial, strain)[component];
  for (const auto& m : faces)
    if (m.component == component && on(node_faces, m.face))
      return m.position(strain) + (m.relative ? initial[component] : 0);
  for (const auto& h : held)
    if (h.component == component && h.faces == node_faces) return initial[component];
  throw core::InternalError("Boundary::position: this component is free");
}

Boundary make_boundary(const LoadingOptions& loading, const core::Vec3& size) {
  if (loading.type == "plane-strain-compression") return plane_strain_compression(loading, size);
  if (loading.type == "uniaxial-tension") return uniaxial(loading, size, 1);
  if (loading.type == "uniaxial-compression") return uniaxial(loading, size, -1);
  if (loading.type == "simple-shear") return simple_shear(loading);
  if (loading.type == "velocity-gradient") return velocity_gradient(loading);
  if (loading.type == "faces") return faces(loading, size);
  throw core::InputError("[loading] type = \"" + loading.type + "\": not known");
}

}  // namespace polyslip::solver
