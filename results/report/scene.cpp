#include "results/report/scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/rotation.hpp"

namespace polyslip::results::report {
namespace {

constexpr std::uint16_t none = 65535;
constexpr int steps = 65534;  // between the ends of a range

template <class T>
void put(std::string& block, T value) {
  static_assert(std::endian::native == std::endian::little);
  block.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::uint16_t quantised(double value, double low, double high) {
  if (!std::isfinite(value)) return none;
  if (!(high > low)) return 0;
  return static_cast<std::uint16_t>(
      std::lround(steps * std::clamp((value - low) / (high - low), 0.0, 1.0)));
}

}  // namespace

std::string mesh_block(const Surface& surface) {
  std::string block;
  for (const auto& triangle : surface.triangles)
    for (const auto node : triangle) put(block, node);
  for (const auto& sides : surface.grains)
    for (const auto grain : sides) put(block, grain);
  for (const auto lines : surface.lines) put(block, lines);
  return block;
}

Box box_of(const Surface& surface, const mesh::Mesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{core::Vec3::Constant(infinity), core::Vec3::Constant(-infinity)};
  for (const int node : surface.nodes) {
    box.low = box.low.cwiseMin(mesh.nodes[node]);
    box.high = box.high.cwiseMax(mesh.nodes[node]);
  }
  return box;
}

std::string state_block(const Surface& surface, const mesh::Mesh& mesh, const Box& box,
                        const StateValues& values,
                        const std::array<Range, quantity_count>& ranges) {
  std::string block;
  for (int i = 0; i < 3; ++i)
    for (const int node : surface.nodes)
      put(block, quantised(mesh.nodes[node][i], box.low[i], box.high[i]));
  for (const int element : surface.elements) {
    const auto& q = values.orientation[element];
    const core::Vec3 colour =
        q.coeffs().allFinite() ? core::paper_colour(q) : core::Vec3::Constant(127);
    for (int i = 0; i < 3; ++i) put(block, static_cast<std::uint8_t>(std::lround(colour[i])));
  }
  if (block.size() % 2 != 0) put(block, std::uint8_t{0});
  for (std::size_t k = 0; k < quantity_count; ++k)
    for (const int element : surface.elements)
      put(block, quantised(values.values[k][element], ranges[k].min, ranges[k].max));
  return block;
}

}  // namespace polyslip::results::report
