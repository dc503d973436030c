// Faces in the pool of mesher processes.

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <list>

#include "core/error.hpp"
#include "mesh/mesher_processes.hpp"

namespace polyslip::mesh {

namespace {

/// Faces that one child meshes one after the other; fixed, as for grains.
constexpr std::size_t batch_size = 200;

void check_mesher(const std::string& name) {
  if (name != own_face_mesher && std::find(known_face_meshers.begin(), known_face_meshers.end(),
                                           name) != known_face_meshers.end())
    return;
  throw core::InputError(fmt::format("face meshers: '{}' is unknown to the pool; there are {}",
                                     name, fmt::join(known_face_meshers, ", ")));
}

/// Meshing of the requests at these places.
MesherWork work_of(const std::vector<FaceRequest>& requests, std::vector<std::size_t> places,
                   const std::string& mesher, double timeout, std::vector<PlanarMesh>& meshes) {
  MesherWork work;
  work.mesher = mesher;
  work.timeout = timeout;
  work.count = places.size();
  work.encode = [&requests, places, mesher, timeout](std::size_t first) {
    protocol::FaceBatch batch{mesher, timeout, {}};
    for (std::size_t i = first; i < places.size(); ++i) batch.faces.push_back(requests[places[i]]);
    return protocol::encode(batch);
  };
  work.name = [&requests, places](std::size_t i) {
    return fmt::format("face {}", requests[places[i]].face + 1);
  };
  work.take = [&requests, &meshes, places](std::size_t i, const protocol::Bytes& answer) {
    PlanarMesh mesh = protocol::decode_face_mesh(answer);
    std::string fault = validate(requests[places[i]].problem, mesh);
    if (fault.empty()) meshes[places[i]] = std::move(mesh);
    return fault;
  };
  work.take_fault = [&meshes, places](std::size_t i, const std::string& why) {
    meshes[places[i]].fault = why;
  };
  return work;
}

}  // namespace

std::vector<PlanarMesh> MesherPool::mesh_faces(const std::vector<FaceRequest>& requests,
                                               const std::string& mesher,
                                               const PoolOptions& options) {
  check_mesher(mesher);
  std::vector<PlanarMesh> meshes(requests.size());
  std::list<MesherTask> tasks;
  std::vector<std::size_t> places;
  const auto close_batch = [&] {
    if (places.empty()) return;
    tasks.emplace_back(work_of(requests, std::move(places), mesher, options.timeout, meshes));
    places = {};
  };
  for (std::size_t i = 0; i < requests.size(); ++i) {
    meshes[i].fault = boundary_fault(requests[i].problem);
    if (!meshes[i].fault.empty()) continue;
    places.push_back(i);
    if (places.size() == batch_size) close_batch();
  }
  close_batch();
  auto waiting = tasks.begin();
  const auto next = [&]() -> MesherTask* { return waiting == tasks.end() ? nullptr : &*waiting++; };
  impl_->run(
      job_count(options.jobs), next, [] {}, [] {});
  return meshes;
}

}  // namespace polyslip::mesh
