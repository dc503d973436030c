#include "mesh/mesher_protocol.hpp"

#include <sys/socket.h>

#include <cerrno>
#include <concepts>
#include <tuple>

namespace polyslip::mesh::protocol {
namespace {

// What messages hold, in their order: written and read by the same list.
template <class T, class Type>
concept Is = std::same_as<std::remove_const_t<T>, Type>;
template <Is<SurfaceMesh> T>
auto fields(T& surface) {
  return std::tie(surface.nodes, surface.triangles);
}
template <Is<GrainRequest> T>
auto fields(T& request) {
  return std::tie(request.grain, request.element_size, request.surface);
}
template <Is<Batch> T>
auto fields(T& batch) {
  return std::tie(batch.mesher, batch.element_size, batch.timeout, batch.optimise, batch.grains);
}
template <Is<VolumeMesh> T>
auto fields(T& mesh) {
  return std::tie(mesh.nodes, mesh.tetrahedra);
}
template <Is<PlanarProblem> T>
auto fields(T& problem) {
  return std::tie(problem.element_size, problem.progression_factor, problem.boundary, problem.sizes,
                  problem.forbidden_edges);
}
template <Is<FaceRequest> T>
auto fields(T& request) {
  return std::tie(request.face, request.problem);
}
template <Is<FaceBatch> T>
auto fields(T& batch) {
  return std::tie(batch.mesher, batch.timeout, batch.faces);
}
template <Is<PlanarMesh> T>
auto fields(T& mesh) {
  return std::tie(mesh.points, mesh.triangles);
}

template <class T>
concept HasFields = requires(T& value) {
  fields(value);
};

class Writer {
 public:
  Writer(Kind kind, std::uint64_t index) : bytes_(sizeof(Header)) {
    header_.magic = magic;
    header_.kind = kind;
    header_.index = index;
  }
  template <class T>
  void put(const T& value) {
    if constexpr (HasFields<const T>) {
      std::apply([this](const auto&... parts) { (put(parts), ...); }, fields(value));
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      put_raw(&value, sizeof(T));
    }
  }
  template <int N>
  void put(const Eigen::Matrix<double, N, 1>& point) {
    put_raw(point.data(), N * sizeof(double));
  }
  void put(const std::string& text) { put_list(text); }
  template <class T>
  void put(const std::vector<T>& values) {
    put_list(values);
  }
  Bytes finish() {
    header_.length = bytes_.size() - sizeof(Header);
    std::memcpy(bytes_.data(), &header_, sizeof(Header));
    return std::move(bytes_);
  }

 private:
  template <class List>
  void put_list(const List& values) {
    put<std::uint64_t>(values.size());
    if constexpr (std::is_trivially_copyable_v<typename List::value_type>)
      put_raw(values.data(), values.size() * sizeof(typename List::value_type));
    else
      for (const auto& value : values) put(value);
  }
  void put_raw(const void* data, std::size_t size) {
    if (size == 0) return;
    const char* begin = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }
  Header header_;
  Bytes bytes_;
};

constexpr const char* too_few = "too few bytes";

class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}
  template <class T>
  void get(T& value) {
    if constexpr (HasFields<T>) {
      std::apply([this](auto&... parts) { (get(parts), ...); }, fields(value));
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      get_raw(&value, sizeof(T));
    }
  }
  template <int N>
  void get(Eigen::Matrix<double, N, 1>& point) {
    get_raw(point.data(), N * sizeof(double));
  }
  void get(std::string& text) { get_list(text); }
  template <class T>
  void get(std::vector<T>& values) {
    get_list(values);
  }
  void finish() const {
    if (position_ != bytes_.size()) throw ProtocolError("more bytes than announced");
  }

 private:
  template <class List>
  void get_list(List& values) {
    using Value = typename List::value_type;
    std::uint64_t count = 0;
    get(count);
    if constexpr (std::is_trivially_copyable_v<Value>) {
      if (count > (bytes_.size() - position_) / sizeof(Value)) throw ProtocolError(too_few);
      values.resize(count);
      get_raw(values.data(), count * sizeof(Value));
    } else {
      // One by one: a wrong count is found out before there is no room for so many.
      values.clear();
      for (std::uint64_t i = 0; i < count; ++i) get(values.emplace_back());
    }
  }
  void get_raw(void* data, std::size_t size) {
    if (size > bytes_.size() - position_) throw ProtocolError(too_few);
    if (size > 0) std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
  }
  const Bytes& bytes_;
  std::size_t position_ = 0;
};

template <class T>
Bytes message(Kind kind, std::uint64_t index, const T& value) {
  Writer w(kind, index);
  w.put(value);
  return w.finish();
}

template <class T>
T decode(const Bytes& payload) {
  Reader r(payload);
  T value;
  r.get(value);
  r.finish();
  return value;
}

}  // namespace

Bytes encode(const Batch& batch) { return message(Kind::batch, 0, batch); }

Bytes encode(const FaceBatch& batch) { return message(Kind::face_batch, 0, batch); }

Bytes encode_begin(std::uint64_t index) { return Writer(Kind::begin, index).finish(); }

Bytes encode_mesh(std::uint64_t index, const VolumeMesh& mesh) {
  return message(Kind::mesh, index, mesh);
}

Bytes encode_mesh(std::uint64_t index, const PlanarMesh& mesh) {
  return message(Kind::mesh, index, mesh);
}

Bytes encode_failed(std::uint64_t index, const std::string& why) {
  return message(Kind::failed, index, why);
}

Header decode_header(const char* bytes) {
  Header header;
  std::memcpy(&header, bytes, sizeof(Header));
  if (header.magic != magic || header.length > max_length) throw ProtocolError("not a header");
  return header;
}

Batch decode_batch(const Bytes& payload) { return decode<Batch>(payload); }
FaceBatch decode_face_batch(const Bytes& payload) { return decode<FaceBatch>(payload); }
VolumeMesh decode_mesh(const Bytes& payload) { return decode<VolumeMesh>(payload); }
PlanarMesh decode_face_mesh(const Bytes& payload) { return decode<PlanarMesh>(payload); }
std::string decode_failed(const Bytes& payload) { return decode<std::string>(payload); }

bool send_all(int socket, const Bytes& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::send(socket, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

bool receive_all(int socket, char* bytes, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = ::recv(socket, bytes + done, count - done, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace polyslip::mesh::protocol
