#include "results/orientation_state.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <limits>
#include <numeric>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rotation.hpp"
#include "results/checksum.hpp"
#include "results/schema.hpp"

namespace polyslip::results {
namespace {

/// Rows of N numbers, one after the other.
template <int N, class Row>
std::vector<double> flatten(const std::vector<Row>& rows) {
  std::vector<double> flat;
  flat.reserve(rows.size() * N);
  for (const Row& row : rows)
    for (int i = 0; i < N; ++i) flat.push_back(row[i]);
  return flat;
}

void write_rows(hdf5::File& file, const OrientationState& state) {
  const ElementTable& t = state.table;
  TableWriter w(file);
  w.set_size("elements", t.volume.size());
  w.put_scalar("time", state.time);
  w.put_scalar("strain", state.strain);
  std::vector<std::int32_t> grain(t.volume.size());
  std::iota(grain.begin(), grain.end(), 1);
  std::vector<core::Vec6> stress(t.cauchy_stress);
  std::vector<Eigen::Vector4d> quaternion;
  std::vector<std::uint8_t> colour;
  for (const auto& q : t.orientation) {
    quaternion.emplace_back(q.w(), q.x(), q.y(), q.z());
    const core::Vec3 rgb = core::paper_colour(q);
    for (int i = 0; i < 3; ++i) colour.push_back(static_cast<std::uint8_t>(rgb[i] + 0.5));
  }
  w.put("mesh/grain", grain);
  w.put("elements/volume", t.volume);
  w.put("elements/orientation", flatten<4>(quaternion));
  w.put("elements/colour", colour);
  w.put("elements/g", t.g);
  w.put("elements/slip", t.slip);
  w.put("elements/equivalent_strain", t.equivalent_strain);
  w.put("elements/cauchy_stress", flatten<6>(stress));
  w.put("elements/pressure", t.pressure);
}

}  // namespace

void write_orientation_state(const std::string& path, const OrientationState& state) {
  const std::string part = core::part_path(path);
  try {
    auto file = hdf5::File::create(part, header_size);
    file.write_attribute("/", "file_type", orientation_file_type);
    file.write_attribute("/", "version", orientation_file_version);
    write_rows(file, state);
    file.close();
    seal(part);
  } catch (...) {
    std::remove(part.c_str());
    throw;
  }
  core::publish_part(path);
}

OrientationState read_orientation_state(const std::string& path) {
  if (!holds_orientations_only(path))
    throw core::InputError(path + ": is a state with a mesh, not one of orientations only");
  const auto file = hdf5::File::open(path);
  TableReader r(file);
  OrientationState s;
  s.time = r.get_scalar<double>("time");
  s.strain = r.get_scalar<double>("strain");
  ElementTable& t = s.table;
  t.volume = r.get<double>("elements/volume");
  constexpr double unset = std::numeric_limits<double>::quiet_NaN();
  t.centroid.assign(t.volume.size(), core::Vec3::Constant(unset));
  const auto q = r.get<double>("elements/orientation");
  for (std::size_t i = 0; i < q.size(); i += 4)
    t.orientation.emplace_back(q[i], q[i + 1], q[i + 2], q[i + 3]);
  t.g = r.get<double>("elements/g");
  t.slip = r.get<double>("elements/slip");
  t.equivalent_strain = r.get<double>("elements/equivalent_strain");
  const auto stress = r.get<double>("elements/cauchy_stress");
  for (std::size_t i = 0; i < stress.size(); i += 6)
    t.cauchy_stress.emplace_back(Eigen::Map<const core::Vec6>(&stress[i]));
  t.pressure = r.get<double>("elements/pressure");
  return s;
}

bool holds_orientations_only(const std::string& path) {
  verify_seal(path);
  const auto file = hdf5::File::open(path);
  return file.read_text_attribute("/", "file_type") == orientation_file_type;
}

}  // namespace polyslip::results
