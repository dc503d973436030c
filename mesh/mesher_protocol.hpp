#pragma once
// What the main program and a mesher process say to each other. Both are the same build on the same
// machine, so numbers travel as they lie in memory; nothing that arrives is believed, though: a
// mesher may have written anywhere before it answers.
//
// Control socket (main program <-> server; SOCK_SEQPACKET): ControlMessage, a `start` with a
// socket. Batch socket (main program <-> child): one `batch` of grains or `face_batch`; then, for
// each grain or face in its order, `begin` and `mesh` or `failed`; after `failed` the child ends.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "mesh/face_mesher.hpp"
#include "mesh/volume_mesher.hpp"

namespace polyslip::mesh::protocol {

/// Most children that a server holds at once.
inline constexpr int max_children = 256;

enum class Control : std::uint32_t {
  start = 1,     ///< to the server: fork a child that serves the attached socket
  kill,          ///< to the server: kill the child with this token
  ended,         ///< from the server: the child ended, value = its wait status
  not_forked,    ///< from the server: no child, value = errno
  not_executed,  ///< from the spawner: no server, value = errno
};

struct ControlMessage {
  Control kind = Control::start;
  std::uint32_t token = 0;
  std::int32_t value = 0;
  std::int32_t unused = 0;
  double cpu_seconds = 0;  ///< of the ended child
};

enum class Kind : std::uint32_t { batch = 1, face_batch, begin, mesh, failed };

struct Header {
  std::uint32_t magic = 0;
  Kind kind = Kind::batch;
  std::uint64_t index = 0;   ///< grain or face within the batch
  std::uint64_t length = 0;  ///< bytes that follow
};
inline constexpr std::uint32_t magic = 0x504d5348;
inline constexpr std::uint64_t max_length = std::uint64_t{1} << 32;

using Bytes = std::vector<char>;

/// The bytes do not hold what they should.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Batch {
  std::string mesher;
  double element_size = 0;
  double timeout = 0;    ///< CPU seconds a grain
  bool optimise = true;  ///< as in PoolOptions
  std::vector<GrainRequest> grains;
};

struct FaceBatch {
  std::string mesher;
  double timeout = 0;  ///< CPU seconds a face
  std::vector<FaceRequest> faces;
};

/// Header and payload in one.
Bytes encode(const Batch& batch);
Bytes encode(const FaceBatch& batch);
Bytes encode_begin(std::uint64_t index);
Bytes encode_mesh(std::uint64_t index, const VolumeMesh& mesh);
Bytes encode_mesh(std::uint64_t index, const PlanarMesh& mesh);
Bytes encode_failed(std::uint64_t index, const std::string& why);

/// Payloads; throw ProtocolError.
Header decode_header(const char* bytes);
Batch decode_batch(const Bytes& payload);
FaceBatch decode_face_batch(const Bytes& payload);
VolumeMesh decode_mesh(const Bytes& payload);
PlanarMesh decode_face_mesh(const Bytes& payload);
std::string decode_failed(const Bytes& payload);

/// Whole buffers over a blocking socket, no SIGPIPE; false if the other side is gone.
bool send_all(int socket, const Bytes& bytes);
bool receive_all(int socket, char* bytes, std::size_t count);

}  // namespace polyslip::mesh::protocol
