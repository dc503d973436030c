#include "mesh/snapshot.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace polyslip::mesh {

FieldReader reader_of(const Snapshot& snapshot) {
  return [&snapshot](const Field& field, std::size_t first, std::size_t last) {
    const std::size_t each = values_each(snapshot, field), owners = owner_count(snapshot, field);
    if (field.values.size() != owners * each)
      throw core::InternalError(
          fmt::format("snapshot: field {} has {} values for {} nodes or elements of {}", field.name,
                      field.values.size(), owners, each));
    const auto begin = field.values.begin();
    return std::vector<double>(begin + static_cast<std::ptrdiff_t>(first * each),
                               begin + static_cast<std::ptrdiff_t>(last * each));
  };
}

}  // namespace polyslip::mesh
