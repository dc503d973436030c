#include "mesh/worker/batch.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <exception>
#include <optional>
#include <system_error>

#include "mesh/mesher_protocol.hpp"
#include "mesh/tetrahedral_optimiser.hpp"
#include "mesh/worker/fault_injection.hpp"
#include "mesh/worker/mesher.hpp"

namespace polyslip::mesh::worker {
namespace {

constexpr rlim_t max_memory = rlim_t{8} << 30;  // bytes that a child may write to

/// Ends of the process: libraries are left as they are, their clean-up may crash.
[[noreturn]] void end(bool well) { _exit(well ? 0 : 1); }

struct Message {
  protocol::Kind kind = protocol::Kind::batch;
  protocol::Bytes payload;
};

std::optional<Message> receive_message(int socket) {
  std::array<char, sizeof(protocol::Header)> bytes{};
  if (!protocol::receive_all(socket, bytes.data(), bytes.size())) return std::nullopt;
  const protocol::Header header = protocol::decode_header(bytes.data());
  Message message{header.kind, protocol::Bytes(header.length)};
  if (!protocol::receive_all(socket, message.payload.data(), message.payload.size()))
    return std::nullopt;
  return message;
}

/// Sets a soft limit, or the hard one if that is lower. A mesher does not run without its limits.
void limit_resource(decltype(RLIMIT_CORE) resource, rlim_t value, const char* name) {
  rlimit limit{};
  if (getrlimit(resource, &limit) == 0) {
    limit.rlim_cur = std::min(value, limit.rlim_max);
    if (setrlimit(resource, &limit) == 0) return;
  }
  throw std::system_error(errno, std::generic_category(), std::string("cannot limit its ") + name);
}

/// No core files, 8 GB to write to and, from now on, `seconds` of CPU for this process; a process
/// that neither computes nor ends is killed by the clock, so late that a loaded machine does not
/// come near it.
void limit_item(double seconds) {
  limit_resource(RLIMIT_CORE, 0, "core files");
  limit_resource(RLIMIT_DATA, max_memory, "memory");
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot tell its CPU time");
  const double used = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                      1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  limit_resource(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(used + seconds)), "CPU time");
  alarm(static_cast<unsigned>(60 + 20 * seconds));
}

/// Runs `mesh` and says why there is no mesh, if so.
template <class Mesh>
std::string guarded(const Mesh& mesh) {
  try {
    return mesh();
  } catch (const std::exception& error) {
    return std::string("exception: ") + error.what();
  } catch (const std::string& error) {
    return "exception: " + error;
  } catch (...) {
    return "exception";
  }
}

/// Meshes one grain, optimises its inside and sends it; the reason if there is no mesh.
std::string mesh_grain(Mesher& mesher, const protocol::Batch& batch, std::uint64_t index,
                       const FaultInjection& faults, int socket) {
  const GrainRequest& grain = batch.grains[index];
  limit_item(batch.timeout);
  faults.before(batch.mesher, grain.grain);
  VolumeMesh mesh =
      mesher.fill(grain.surface, grain.element_size > 0 ? grain.element_size : batch.element_size);
  std::string fault = validate(grain.surface, mesh);
  if (!fault.empty()) return fault;
  if (batch.optimise && mesher.is_optimised() && !faults.unoptimised(batch.mesher, grain.grain))
    mesh = optimise_inside(grain.surface, mesh);
  faults.after(batch.mesher, grain.grain, mesh, socket);
  if (!protocol::send_all(socket, protocol::encode_mesh(index, mesh))) end(false);
  return {};
}

/// The same for a face, whose forbidden edges are cut.
std::string mesh_face(FaceMesher& mesher, const protocol::FaceBatch& batch, std::uint64_t index,
                      const FaultInjection& faults, int socket) {
  const auto& [face, problem] = batch.faces[index];
  limit_item(batch.timeout);
  faults.before(batch.mesher, face);
  PlanarMesh mesh = mesher.mesh(problem);
  if (!split_forbidden_edges(problem, mesh))
    return "an inner edge between nodes of its boundary is too flat to be cut";
  std::string fault = validate(problem, mesh);
  if (!fault.empty()) return fault;
  faults.after(batch.mesher, face, mesh, socket);
  if (!protocol::send_all(socket, protocol::encode_mesh(index, mesh))) end(false);
  return {};
}

/// `mesh_item` for one after the other. After a fault the library may be locked or half-way: the
/// next one gets a process of its own.
template <class MeshItem>
[[noreturn]] void serve(int socket, std::size_t count, const MeshItem& mesh_item) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!protocol::send_all(socket, protocol::encode_begin(i))) end(false);
    const std::string fault = guarded([&] { return mesh_item(i); });
    if (fault.empty()) continue;
    protocol::send_all(socket, protocol::encode_failed(i, fault));
    end(false);
  }
  end(true);
}

[[noreturn]] void serve_grains(int socket, const protocol::Bytes& payload) {
  const auto batch = protocol::decode_batch(payload);
  const auto mesher = make_mesher(batch.mesher);
  if (!mesher) end(false);
  const FaultInjection faults = FaultInjection::from_environment();
  serve(socket, batch.grains.size(),
        [&](std::uint64_t i) { return mesh_grain(*mesher, batch, i, faults, socket); });
}

[[noreturn]] void serve_faces(int socket, const protocol::Bytes& payload) {
  const auto batch = protocol::decode_face_batch(payload);
  const auto mesher = make_face_mesher(batch.mesher);
  if (!mesher) end(false);
  const FaultInjection faults = FaultInjection::from_environment();
  serve(socket, batch.faces.size(),
        [&](std::uint64_t i) { return mesh_face(*mesher, batch, i, faults, socket); });
}

}  // namespace

void serve_batch(int socket) {
  try {
    const auto message = receive_message(socket);
    if (!message) end(false);
    if (message->kind == protocol::Kind::batch) serve_grains(socket, message->payload);
    if (message->kind == protocol::Kind::face_batch) serve_faces(socket, message->payload);
    end(false);
  } catch (...) {
    end(false);
  }
}

}  // namespace polyslip::mesh::worker
