#pragma once
// The body that a polycrystal fills: a convex polyhedron given by outward planes. A cylinder or a
// sphere is one with many facets of one name.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace polyslip::mesh {

/// n . x = d, |n| = 1
struct Plane {
  core::Vec3 normal = core::Vec3::UnitX();
  double offset = 0;
};

/// A facet of the domain: n . x <= d inside.
struct DomainFace {
  std::string name;       ///< facets of one name are one surface of the specimen
  Plane plane;            ///< normal out of the domain
  std::vector<int> loop;  ///< vertices of the domain, anticlockwise seen from outside
};

struct DomainEdge {
  std::array<int, 2> vertices{-1, -1}, faces{-1, -1};
};

/// The bounding box of the domain is [0, size]. Topology::domain_face is an index of `faces`; those
/// of a box are x0 x1 y0 y1 z0 z1.
struct Domain {
  std::string shape = "box";
  std::vector<DomainFace> faces;
  std::vector<DomainEdge> edges;
  std::vector<core::Vec3> vertices;
  core::Vec3 size{0, 0, 0};
  double volume = 0;
  /// Where its planes were given: x here is scale (x there - origin).
  core::Vec3 origin{0, 0, 0};
  double scale = 1;
  /// Of cylinders and spheres: volume over that of the true body, less one, and the width of a side
  /// or the root of the mean facet's area.
  double faceting_error = 0, facet_size = 0;
  /// Periodic directions, with the period size[i]; of a box only.
  std::array<bool, 3> periodic{false, false, false};

  bool is_box() const { return shape == "box"; }
  bool is_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
  int face_count() const { return static_cast<int>(faces.size()); }
  /// Whether x lies in the domain, `margin` or more from each of its faces; false for NaN.
  bool contains(const core::Vec3& x, double margin = 0) const {
    for (const DomainFace& face : faces)
      if (!(face.plane.normal.dot(x) <= face.plane.offset - margin)) return false;
    return true;
  }
  /// The names of the facets, each once, in the order of the facets.
  std::vector<std::string> surface_names() const;
  /// [faces] index of the facet's name in surface_names.
  std::vector<int> surface_of_face() const;
};

/// The box [0, size]. InputError unless all lengths are positive.
Domain box_domain(const core::Vec3& size);

/// The points with n . x <= d for all planes, moved so that the bounding box begins at the origin,
/// and scaled uniformly to the given volume (0: not scaled). Normals need not have unit length: n
/// and d are divided by it. InputError, naming the plane (from 1), if one is no plane or bounds
/// nothing, or if the planes enclose no body.
Domain convex_domain(const std::string& shape, std::vector<Plane> planes,
                     const std::vector<std::string>& names, double volume = 0);

/// A point near x that lies on the planes; the nearest one if they are not along the axes. Along an
/// axis the coordinate is set exactly. Planes that depend on earlier ones are passed over.
void put_on_planes(std::span<const Plane> planes, core::Vec3& x);

/// Orthonormal directions, at most three.
struct Directions {
  std::array<core::Vec3, 3> directions;
  int count = 0;
  const core::Vec3& operator[](int i) const { return directions[i]; }
};
/// A basis of the directions that lie in all the planes; the axes where they do.
Directions free_directions(std::span<const Plane> planes);

/// Sorted ids of the domain faces of each entity (vertex or edge), stored one after the other.
class DomainFaceLists {
 public:
  DomainFaceLists() = default;
  /// `pairs`: entity and domain face, in any order, with repetitions.
  DomainFaceLists(std::size_t entities, std::vector<std::array<int, 2>> pairs);
  std::span<const int> operator[](std::size_t entity) const {
    return {faces_.data() + starts_[entity], faces_.data() + starts_[entity + 1]};
  }

 private:
  std::vector<int> starts_, faces_;
};

struct Topology;
DomainFaceLists domain_faces_of_vertices(const Topology& topology);
DomainFaceLists domain_faces_of_edges(const Topology& topology);

}  // namespace polyslip::mesh
