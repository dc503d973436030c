// The only file that includes gmsh.h. What of Gmsh 4.8.4 works, hangs or silently does nothing is
// listed in the design page, section 4; this file keeps to the calls that work.

#include <gmsh.h>

#include <algorithm>
#include <map>

#include "mesh/worker/mesher.hpp"

namespace polyslip::mesh::worker {
namespace {

constexpr int triangle_type = 2, tetrahedron_type = 4;  // Gmsh element types
constexpr double generation_threshold = 0.3, optimised_below = 0.6;
constexpr int surface_tag = 1, volume_tag = 1;

std::vector<double> coordinates(const std::vector<core::Vec3>& nodes, std::size_t first) {
  std::vector<double> xyz;
  xyz.reserve(3 * (nodes.size() - first));
  for (std::size_t i = first; i < nodes.size(); ++i)
    xyz.insert(xyz.end(), nodes[i].data(), nodes[i].data() + 3);
  return xyz;
}

/// Node i has tag i + 1.
std::vector<std::size_t> node_tags(std::size_t first, std::size_t last) {
  std::vector<std::size_t> tags;
  for (std::size_t i = first; i < last; ++i) tags.push_back(i + 1);
  return tags;
}

template <std::size_t N>
std::vector<std::size_t> connectivity(const std::vector<std::array<int, N>>& elements) {
  std::vector<std::size_t> tags;
  tags.reserve(N * elements.size());
  for (const auto& element : elements)
    for (const int n : element) tags.push_back(static_cast<std::size_t>(n) + 1);
  return tags;
}

/// A new model with the surface as a discrete entity: Gmsh keeps it as it is.
void add_surface(const SurfaceMesh& surface) {
  gmsh::clear();
  gmsh::model::add("grain");
  gmsh::model::addDiscreteEntity(2, surface_tag);
  gmsh::model::mesh::addNodes(2, surface_tag, node_tags(0, surface.nodes.size()),
                              coordinates(surface.nodes, 0));
  gmsh::model::mesh::addElementsByType(surface_tag, triangle_type, {},
                                       connectivity(surface.triangles));
}

/// The model's tetrahedra; surface nodes (tags 1 ... count) first, then by tag.
VolumeMesh read_volume(std::size_t surface_node_count) {
  std::vector<std::size_t> tags, elements, corners;
  std::vector<double> xyz, parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters, -1, -1, false, false);
  gmsh::model::mesh::getElementsByType(tetrahedron_type, elements, corners);
  std::map<std::size_t, core::Vec3> nodes;
  for (std::size_t i = 0; i < tags.size(); ++i)
    nodes[tags[i]] = core::Vec3(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  VolumeMesh mesh;
  std::map<std::size_t, int> number;
  for (const auto& [tag, x] : nodes) {
    number[tag] = static_cast<int>(mesh.nodes.size());
    mesh.nodes.push_back(x);
  }
  for (std::size_t i = 0; i + 3 < corners.size(); i += 4)
    mesh.tetrahedra.push_back({number.at(corners[i]), number.at(corners[i + 1]),
                               number.at(corners[i + 2]), number.at(corners[i + 3])});
  return without_unused_nodes(mesh, surface_node_count);
}

/// Gmsh's optimiser on every tetrahedron below `optimised_below` (Gmsh's gamma). The threshold is
/// an option for all: HXT, which reads it too, would take forty times longer with this one.
void optimise() {
  gmsh::option::setNumber("Mesh.OptimizeThreshold", optimised_below);
  gmsh::model::mesh::optimize("", true);
  gmsh::option::setNumber("Mesh.OptimizeThreshold", generation_threshold);
}

class GmshMesher : public Mesher {
 public:
  explicit GmshMesher(GmshAlgorithm algorithm) : algorithm_(algorithm) {}

  VolumeMesh fill(const SurfaceMesh& surface, double element_size) override {
    gmsh::option::setNumber("Mesh.Algorithm3D", static_cast<double>(algorithm_));
    gmsh::option::setNumber("Mesh.MeshSizeMax", size_share * element_size);
    add_surface(surface);
    gmsh::model::geo::addSurfaceLoop({surface_tag}, 1);
    gmsh::model::geo::addVolume({1}, volume_tag);
    gmsh::model::geo::synchronize();
    gmsh::model::mesh::generate(3);
    optimise();
    return read_volume(surface.nodes.size());
  }

 private:
  GmshAlgorithm algorithm_;
};

/// Boundary node i is point i + 1, the straight line to the next one curve i + 1: one element each.
class GmshFaceMesher : public FaceMesher {
 public:
  explicit GmshFaceMesher(GmshFaceAlgorithm algorithm) : algorithm_(algorithm) {}

  PlanarMesh mesh(const PlanarProblem& problem) override {
    gmsh::option::setNumber("Mesh.Algorithm", static_cast<double>(algorithm_));
    gmsh::option::setNumber("Mesh.MeshSizeMax", problem.element_size);
    add_polygon(problem);
    gmsh::model::mesh::generate(2);
    return read_face(problem);
  }

 private:
  static void add_polygon(const PlanarProblem& problem) {
    gmsh::clear();
    gmsh::model::add("face");
    const int n = static_cast<int>(problem.boundary.size());
    std::vector<int> lines;
    for (int i = 0; i < n; ++i)
      gmsh::model::geo::addPoint(problem.boundary[i][0], problem.boundary[i][1], 0,
                                 std::min(problem.sizes[i], problem.element_size), i + 1);
    for (int i = 0; i < n; ++i)
      lines.push_back(gmsh::model::geo::addLine(i + 1, (i + 1) % n + 1, i + 1));
    for (const int line : lines) gmsh::model::geo::mesh::setTransfiniteCurve(line, 2);
    gmsh::model::geo::addCurveLoop(lines, 1);
    gmsh::model::geo::addPlaneSurface({1}, surface_tag);
    gmsh::model::geo::synchronize();
  }

  static PlanarMesh read_face(const PlanarProblem& problem) {
    PlanarMesh mesh;
    mesh.points = problem.boundary;
    std::map<std::size_t, int> number;
    std::vector<std::size_t> tags, elements, corners;
    std::vector<double> xyz, parameters;
    for (int i = 0; i < static_cast<int>(problem.boundary.size()); ++i) {
      gmsh::model::mesh::getNodes(tags, xyz, parameters, 0, i + 1, false, false);
      number[tags.at(0)] = i;
    }
    gmsh::model::mesh::getNodes(tags, xyz, parameters, 2, surface_tag, false, false);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      number[tags[i]] = static_cast<int>(mesh.points.size());
      mesh.points.push_back({xyz[3 * i], xyz[3 * i + 1]});
    }
    gmsh::model::mesh::getElementsByType(triangle_type, elements, corners, surface_tag);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      mesh.triangles.push_back(
          {number.at(corners[i]), number.at(corners[i + 1]), number.at(corners[i + 2])});
    return mesh;
  }

  GmshFaceAlgorithm algorithm_;
};

}  // namespace

void initialise_gmsh() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.Verbosity", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("General.AbortOnError", 0);
  gmsh::option::setNumber("Mesh.OptimizeThreshold", generation_threshold);
}

std::unique_ptr<Mesher> make_gmsh_mesher(GmshAlgorithm algorithm) {
  return std::make_unique<GmshMesher>(algorithm);
}

std::unique_ptr<FaceMesher> make_gmsh_face_mesher(GmshFaceAlgorithm algorithm) {
  return std::make_unique<GmshFaceMesher>(algorithm);
}

VolumeMesh optimise_with_gmsh(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  add_surface(surface);
  gmsh::model::addDiscreteEntity(3, volume_tag, {surface_tag});
  const std::size_t first = surface.nodes.size();
  gmsh::model::mesh::addNodes(3, volume_tag, node_tags(first, mesh.nodes.size()),
                              coordinates(mesh.nodes, first));
  gmsh::model::mesh::addElementsByType(volume_tag, tetrahedron_type, {},
                                       connectivity(mesh.tetrahedra));
  optimise();
  return read_volume(first);
}

}  // namespace polyslip::mesh::worker
