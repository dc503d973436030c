#include "mesh/mesher_protocol.hpp"

#include <sys/socket.h>

#include <cerrno>

namespace polyslip::mesh::protocol {
namespace {

class Writer {
 public:
  Writer(Kind kind, std::uint64_t index) : bytes_(sizeof(Header)) {
    header_.magic = magic;
    header_.kind = kind;
    header_.index = index;
  }
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_raw(&value, sizeof(T));
  }
  void put(const std::string& text) {
    put<std::uint64_t>(text.size());
    put_raw(text.data(), text.size());
  }
  template <int N>
  void put(const std::vector<Eigen::Matrix<double, N, 1>>& points) {
    put<std::uint64_t>(points.size());
    for (const auto& p : points) put_raw(p.data(), N * sizeof(double));
  }
  void put(const std::vector<double>& values) {
    put<std::uint64_t>(values.size());
    put_raw(values.data(), values.size() * sizeof(double));
  }
  template <std::size_t N>
  void put(const std::vector<std::array<int, N>>& rows) {
    put<std::uint64_t>(rows.size());
    if (!rows.empty()) put_raw(rows.data(), rows.size() * sizeof(rows[0]));
  }
  Bytes finish() {
    header_.length = bytes_.size() - sizeof(Header);
    std::memcpy(bytes_.data(), &header_, sizeof(Header));
    return std::move(bytes_);
  }

 private:
  void put_raw(const void* data, std::size_t size) {
    if (size == 0) return;
    const char* begin = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }
  Header header_;
  Bytes bytes_;
};

class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    get_raw(&value, sizeof(T));
    return value;
  }
  std::string get_string() {
    std::string text(get_count(1), '\0');
    get_raw(text.data(), text.size());
    return text;
  }
  template <int N>
  std::vector<Eigen::Matrix<double, N, 1>> get_points() {
    std::vector<Eigen::Matrix<double, N, 1>> points(get_count(N * sizeof(double)));
    for (auto& p : points) get_raw(p.data(), N * sizeof(double));
    return points;
  }
  std::vector<double> get_values() {
    std::vector<double> values(get_count(sizeof(double)));
    get_raw(values.data(), values.size() * sizeof(double));
    return values;
  }
  template <std::size_t N>
  std::vector<std::array<int, N>> get_rows() {
    std::vector<std::array<int, N>> rows(get_count(N * sizeof(int)));
    if (!rows.empty()) get_raw(rows.data(), rows.size() * sizeof(rows[0]));
    return rows;
  }
  void finish() const {
    if (position_ != bytes_.size()) throw ProtocolError("more bytes than announced");
  }

 private:
  std::size_t get_count(std::size_t item_size) {
    const auto count = get<std::uint64_t>();
    if (count > (bytes_.size() - position_) / item_size) throw ProtocolError("too few bytes");
    return count;
  }
  void get_raw(void* data, std::size_t size) {
    if (size > bytes_.size() - position_) throw ProtocolError("too few bytes");
    if (size > 0) std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
  }
  const Bytes& bytes_;
  std::size_t position_ = 0;
};

}  // namespace

Bytes encode(const Batch& batch) {
  Writer w(Kind::batch, 0);
  w.put(batch.mesher);
  w.put(batch.element_size);
  w.put(batch.timeout);
  w.put(batch.optimise);
  w.put<std::uint64_t>(batch.grains.size());
  for (const auto& grain : batch.grains) {
    w.put(grain.grain);
    w.put(grain.element_size);
    w.put(grain.surface.nodes);
    w.put(grain.surface.triangles);
  }
  return w.finish();
}

Bytes encode(const FaceBatch& batch) {
  Writer w(Kind::face_batch, 0);
  w.put(batch.mesher);
  w.put(batch.timeout);
  w.put<std::uint64_t>(batch.faces.size());
  for (const auto& [face, problem] : batch.faces) {
    w.put(face);
    w.put(problem.element_size);
    w.put(problem.progression_factor);
    w.put(problem.boundary);
    w.put(problem.sizes);
    w.put(problem.forbidden_edges);
  }
  return w.finish();
}

Bytes encode_begin(std::uint64_t index) { return Writer(Kind::begin, index).finish(); }

Bytes encode_mesh(std::uint64_t index, const VolumeMesh& mesh) {
  Writer w(Kind::mesh, index);
  w.put(mesh.nodes);
  w.put(mesh.tetrahedra);
  return w.finish();
}

Bytes encode_mesh(std::uint64_t index, const PlanarMesh& mesh) {
  Writer w(Kind::mesh, index);
  w.put(mesh.points);
  w.put(mesh.triangles);
  return w.finish();
}

Bytes encode_failed(std::uint64_t index, const std::string& why) {
  Writer w(Kind::failed, index);
  w.put(why);
  return w.finish();
}

Header decode_header(const char* bytes) {
  Header header;
  std::memcpy(&header, bytes, sizeof(Header));
  if (header.magic != magic || header.length > max_length) throw ProtocolError("not a header");
  return header;
}

Batch decode_batch(const Bytes& payload) {
  Reader r(payload);
  Batch batch;
  batch.mesher = r.get_string();
  batch.element_size = r.get<double>();
  batch.timeout = r.get<double>();
  batch.optimise = r.get<bool>();
  const auto count = r.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    GrainRequest grain;
    grain.grain = r.get<int>();
    grain.element_size = r.get<double>();
    grain.surface.nodes = r.get_points<3>();
    grain.surface.triangles = r.get_rows<3>();
    batch.grains.push_back(std::move(grain));
  }
  r.finish();
  return batch;
}

FaceBatch decode_face_batch(const Bytes& payload) {
  Reader r(payload);
  FaceBatch batch;
  batch.mesher = r.get_string();
  batch.timeout = r.get<double>();
  const auto count = r.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    FaceRequest request;
    request.face = r.get<int>();
    PlanarProblem& problem = request.problem;
    problem.element_size = r.get<double>();
    problem.progression_factor = r.get<double>();
    problem.boundary = r.get_points<2>();
    problem.sizes = r.get_values();
    problem.forbidden_edges = r.get_rows<2>();
    batch.faces.push_back(std::move(request));
  }
  r.finish();
  return batch;
}

PlanarMesh decode_face_mesh(const Bytes& payload) {
  Reader r(payload);
  PlanarMesh mesh;
  mesh.points = r.get_points<2>();
  mesh.triangles = r.get_rows<3>();
  r.finish();
  return mesh;
}

VolumeMesh decode_mesh(const Bytes& payload) {
  Reader r(payload);
  VolumeMesh mesh;
  mesh.nodes = r.get_points<3>();
  mesh.tetrahedra = r.get_rows<4>();
  r.finish();
  return mesh;
}

std::string decode_failed(const Bytes& payload) {
  Reader r(payload);
  std::string why = r.get_string();
  r.finish();
  return why;
}

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
