// Meshes of faces: projection, candidates of several meshers, the best of them carried back.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/parallel.hpp"
#include "mesh/boundary_mesh.hpp"
#include "mesh/inner_edges.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// How far beyond the old face, in its extent, a node may be that is put on its nearest point.
constexpr double farthest_beyond = 0.02;
/// Faces whose plane meshes are held at once.
constexpr std::size_t chunk = 10000;

}  // namespace

/// A face on its way through the meshers.
struct BoundaryMesher::FaceWork {
  std::optional<FaceProjection> projection;
  FaceRequest request;
  std::optional<FaceCandidates> candidates;  ///< none: copied, or no mesh is possible
  std::string fault;                         ///< of the last mesher that failed
  bool done = false;
  bool open() const { return candidates && !candidates->good_enough(); }
};

BoundaryMesher::Nodes BoundaryMesher::nodes() const {
  Nodes nodes{numbers(), {}, {}};
  nodes.positions = positions(nodes.numbers);
  nodes.sizes = node_sizes(nodes.numbers);
  return nodes;
}

std::vector<std::string> BoundaryMesher::mesh_list(const std::vector<int>& faces,
                                                   const Nodes& nodes) {
  std::vector<std::string> faults(faces.size());
  for (std::size_t first = 0; first < faces.size(); first += chunk) {
    const std::size_t count = std::min(chunk, faces.size() - first);
    mesh_chunk({faces.data() + first, count}, nodes, {faults.data() + first, count});
  }
  return faults;
}

void BoundaryMesher::mesh_chunk(std::span<const int> faces, const Nodes& nodes,
                                std::span<std::string> faults) {
  constexpr std::array<Way, 1> first_mesh{{{Flattening::mean_plane, -1}}};
  constexpr std::array<Way, 5> remeshing{{{Flattening::mean_plane, 0.4},
                                          {Flattening::conformal, 0.2},
                                          {Flattening::isotropic_plane, 0.05},
                                          {Flattening::conformal, 0.01},
                                          {Flattening::circle, 0.001}}};
  core::parallel_for(core::thread_count(options_.jobs), faces.size(), [&](std::size_t i) {
    face_mesher_[faces[i]] = -1;
    if (face_copied_[faces[i]]) copy_face_mesh(faces[i]);
  });
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (!face_copied_[faces[i]]) left.push_back(i);
  const std::span<const Way> ways =
      geometry_.from_mesh ? std::span<const Way>(remeshing) : std::span<const Way>(first_mesh);
  for (const Way& way : ways) {
    std::vector<FaceWork> works(left.size());
    std::vector<FaceWork*> all;
    for (std::size_t k = 0; k < left.size(); ++k) {
      works[k].request.face = faces[left[k]];
      all.push_back(&works[k]);
    }
    mesh_flattened(way, nodes, all);
    std::vector<std::size_t> failed;
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (works[k].done) {
        faults[left[k]].clear();
        continue;
      }
      if (faults[left[k]].empty()) faults[left[k]] = works[k].fault;
      failed.push_back(left[k]);
    }
    left = std::move(failed);
    if (left.empty()) return;
  }
}

/// The faces, laid flat in one way, by all meshers.
void BoundaryMesher::mesh_flattened(const Way& way, const Nodes& nodes,
                                    const std::vector<FaceWork*>& works) {
  const int threads = core::thread_count(options_.jobs);
  core::parallel_for(threads, works.size(),
                     [&](std::size_t i) { begin_face(way, nodes, *works[i]); });
  for (std::size_t mesher = 0; mesher < options_.face_meshers.size(); ++mesher)
    try_mesher(mesher, works);
  core::parallel_for(threads, works.size(), [&](std::size_t i) { finish_face(nodes, *works[i]); });
}

void BoundaryMesher::begin_face(const Way& way, const Nodes& nodes, FaceWork& work) {
  const int face = work.request.face;
  faces_[face] = {};  // its nodes are those of its edges only
  faces_[face].flattening = way.flattening;
  const FaceProjection& projection =
      work.projection.emplace(this->projection(face, way.flattening));
  if (way.share >= 0 && !projection.projects(way.share)) {
    work.fault = "its surface does not project on a plane";
    return;
  }
  PlanarProblem& problem = work.request.problem;
  problem.element_size = sizes_.faces[face];
  problem.progression_factor = options_.progression_factor;
  problem.forbidden_edges = forbidden_[face];
  const auto boundary_nodes = face_nodes(face, nodes.numbers);
  for (const int n : boundary_nodes) {
    problem.boundary.push_back(projection.project(nodes.positions[n]));
    problem.sizes.push_back(nodes.sizes[n]);
  }
  if (!projection.is_mean_plane()) {
    for (std::size_t i = 0; i < boundary_nodes.size(); ++i)
      if (const Vec3& x = nodes.positions[boundary_nodes[i]];
          !((projection.lift(problem.boundary[i]) - x).cwiseProduct(scale_).norm() <=
            farthest_beyond * projection.extent())) {
        work.fault = "its edges are not where its surface ends";
        return;
      }
    take_flat_sizes(problem, boundary_nodes, nodes.positions);
  }
  work.fault = boundary_fault(problem);
  if (work.fault.empty()) work.candidates.emplace(problem);
}

/// Faces that have no mesh above the floor yet.
void BoundaryMesher::try_mesher(std::size_t mesher, const std::vector<FaceWork*>& works) {
  std::vector<FaceWork*> open;
  for (auto* work : works)
    if (work->open()) open.push_back(work);
  if (open.empty()) return;
  const bool own = options_.face_meshers[mesher] == own_face_mesher;
  std::vector<PlanarMesh> meshes(open.size());
  if (own) {
    core::parallel_for(core::thread_count(options_.jobs), open.size(),
                       [&](std::size_t i) { mesh_polygon(open[i]->request.problem, meshes[i]); });
  } else {
    std::vector<FaceRequest> requests;
    for (const auto* work : open) requests.push_back(work->request);
    meshes = face_meshers_(requests, options_.face_meshers[mesher]);
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (!meshes[i].fault.empty()) {
      open[i]->fault = meshes[i].fault;
      if (!own) face_faults_.push_back(meshes[i].fault);
    }
    open[i]->candidates->offer(mesher, std::move(meshes[i]));
  }
}

void BoundaryMesher::finish_face(const Nodes& nodes, FaceWork& work) {
  if (!work.candidates || !work.candidates->any()) return;
  const int face = work.request.face;
  const PlanarMesh& plane = work.candidates->best();
  const FaceProjection& projection = *work.projection;
  FaceMesh& result = faces_[face];
  result.boundary_count = static_cast<int>(work.request.problem.boundary.size());
  std::vector<Vec3> x;
  for (const int n : face_nodes(face, nodes.numbers)) x.push_back(nodes.positions[n]);
  double farthest = 0;
  for (std::size_t i = x.size(); i < plane.points.size(); ++i) {
    double beyond = 0;
    Vec3 lifted = projection.lift(plane.points[i], &beyond);
    keep_in_plane_of(face, lifted);
    x.push_back(lifted);
    result.nearest_points += beyond > 0;
    farthest = std::max(farthest, beyond);
    result.inner_nodes.push_back(lifted);
  }
  result.triangles = plane.triangles;
  result.places = plane.points;
  for (const auto& [a, b, t, i] : inner_edges(plane.triangles))
    result.inner_edges.push_back({a, b, Vec3::Zero()});
  farthest = std::max(farthest, place_mids(face, projection, x));
  work.done = farthest <= farthest_beyond * projection.extent();
  if (work.done)
    face_mesher_[face] = static_cast<int>(work.candidates->mesher());
  else
    work.fault =
        fmt::format("a node of its mesh is {:.3g} beyond its old surface, of {:.3g} extent",
                    farthest, projection.extent());
}

/// Where the plane stretches lengths, sizes go with those of the 1D elements around.
void BoundaryMesher::take_flat_sizes(PlanarProblem& problem, const std::vector<int>& nodes,
                                     const std::vector<Vec3>& positions) const {
  const std::size_t n = problem.boundary.size();
  std::vector<double> flat(n), real(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    flat[i] = (problem.boundary[j] - problem.boundary[i]).norm();
    real[i] = (positions[nodes[j]] - positions[nodes[i]]).cwiseProduct(scale_).norm();
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    problem.sizes[i] *= (flat[i] + flat[before]) / (real[i] + real[before]);
  }
}

std::vector<int> BoundaryMesher::face_wins() const {
  std::vector<int> wins(options_.face_meshers.size(), 0);
  for (const int mesher : face_mesher_)
    if (mesher >= 0) ++wins[mesher];
  return wins;
}

}  // namespace polyslip::mesh
