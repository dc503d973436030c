// Messages between the main program and its mesher processes.

#include "mesh/mesher_protocol.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace polyslip::mesh::protocol {
namespace {

using core::Vec3;

/// What follows the header, which says how long that is.
Bytes payload(const Bytes& message, Kind kind, std::uint64_t index) {
  const Header header = decode_header(message.data());
  EXPECT_EQ(header.kind, kind);
  EXPECT_EQ(header.index, index);
  EXPECT_EQ(header.length, message.size() - sizeof header);
  return {message.begin() + sizeof header, message.end()};
}

Batch two_grains() {
  Batch batch{"netgen", 0.25, 3, false, {}};
  batch.grains.push_back({7, {{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, {{0, 1, 2}, {2, 1, 0}}}, 0.5});
  batch.grains.push_back({9, {}, 0});
  return batch;
}

FaceBatch one_face() {
  FaceBatch batch{"gmsh-frontal", 2, {}};
  PlanarProblem problem;
  problem.boundary = {{0, 0}, {1, 0}, {0.5, 0.75}};
  problem.sizes = {0.1, 0.2, 0.4};
  problem.element_size = 0.3;
  problem.progression_factor = 1.5;
  problem.forbidden_edges = {{0, 2}};
  batch.faces.push_back({4, problem});
  return batch;
}

const VolumeMesh volume{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};

PlanarMesh planar() {
  PlanarMesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(MesherProtocol, CarriesGrains) {
  const Batch sent = two_grains();
  const Batch got = decode_batch(payload(encode(sent), Kind::batch, 0));
  EXPECT_EQ(got.mesher, sent.mesher);
  EXPECT_EQ(got.element_size, sent.element_size);
  EXPECT_EQ(got.timeout, sent.timeout);
  EXPECT_EQ(got.optimise, sent.optimise);
  ASSERT_EQ(got.grains.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(got.grains[i].grain, sent.grains[i].grain);
    EXPECT_EQ(got.grains[i].element_size, sent.grains[i].element_size);
    EXPECT_EQ(got.grains[i].surface.nodes, sent.grains[i].surface.nodes);
    EXPECT_EQ(got.grains[i].surface.triangles, sent.grains[i].surface.triangles);
  }
}

TEST(MesherProtocol, CarriesFaces) {
  const FaceBatch sent = one_face();
  const FaceBatch got = decode_face_batch(payload(encode(sent), Kind::face_batch, 0));
  EXPECT_EQ(got.mesher, sent.mesher);
  EXPECT_EQ(got.timeout, sent.timeout);
  ASSERT_EQ(got.faces.size(), 1u);
  const auto &is = got.faces[0].problem, &was = sent.faces[0].problem;
  EXPECT_EQ(got.faces[0].face, 4);
  EXPECT_EQ(is.boundary, was.boundary);
  EXPECT_EQ(is.sizes, was.sizes);
  EXPECT_EQ(is.element_size, was.element_size);
  EXPECT_EQ(is.progression_factor, was.progression_factor);
  EXPECT_EQ(is.forbidden_edges, was.forbidden_edges);
}

TEST(MesherProtocol, CarriesAnswers) {
  const auto of_grain = decode_mesh(payload(encode_mesh(3, volume), Kind::mesh, 3));
  EXPECT_EQ(of_grain.nodes, volume.nodes);
  EXPECT_EQ(of_grain.tetrahedra, volume.tetrahedra);
  const auto of_face = decode_face_mesh(payload(encode_mesh(5, planar()), Kind::mesh, 5));
  EXPECT_EQ(of_face.points, planar().points);
  EXPECT_EQ(of_face.triangles, planar().triangles);
  EXPECT_EQ(decode_failed(payload(encode_failed(2, "it is flat"), Kind::failed, 2)), "it is flat");
  EXPECT_TRUE(payload(encode_begin(6), Kind::begin, 6).empty());
}

TEST(MesherProtocol, BelievesNoMessageThatIsCutOrTooLong) {
  const std::vector<std::pair<Bytes, std::function<void(const Bytes&)>>> messages{
      {encode(two_grains()), [](const Bytes& b) { decode_batch(b); }},
      {encode(one_face()), [](const Bytes& b) { decode_face_batch(b); }},
      {encode_mesh(0, volume), [](const Bytes& b) { decode_mesh(b); }},
      {encode_mesh(0, planar()), [](const Bytes& b) { decode_face_mesh(b); }},
      {encode_failed(0, "why"), [](const Bytes& b) { decode_failed(b); }}};
  for (const auto& [message, decode] : messages) {
    const Bytes whole(message.begin() + sizeof(Header), message.end());
    EXPECT_NO_THROW(decode(whole));
    for (std::size_t length = 0; length < whole.size(); ++length)
      EXPECT_THROW(decode(Bytes(whole.begin(), whole.begin() + static_cast<long>(length))),
                   ProtocolError)
          << length;
    Bytes longer = whole;
    longer.push_back(0);
    EXPECT_THROW(decode(longer), ProtocolError);
  }
}

TEST(MesherProtocol, AsksForNoMoreRoomThanThereAreBytes) {
  Bytes wild(64, '\xff');  // counts of 2^64 - 1
  EXPECT_THROW(decode_mesh(wild), ProtocolError);
  EXPECT_THROW(decode_failed(wild), ProtocolError);
  EXPECT_THROW(decode_face_mesh(wild), ProtocolError);
  EXPECT_THROW(decode_header(wild.data()), ProtocolError);
}

}  // namespace
}  // namespace polyslip::mesh::protocol
