#include "solver/field_parts.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

/// {field, first, last}; a negative field ends the service.
using Request = std::array<std::int64_t, 3>;
constexpr Request no_more{-1, 0, 0};

std::vector<double> answer(const Distribution& distribution, const FieldPart& part,
                           const Request& request) {
  const auto first = static_cast<std::size_t>(request[1]),
             last = static_cast<std::size_t>(request[2]);
  return part.outline.location == mesh::Location::node
             ? distribution.gather_node_rows(part.append, first, last, part.each)
             : distribution.gather_element_rows(part.append, first, last, part.each);
}

const FieldPart* find(const std::vector<FieldPart>& parts, const mesh::Field& field) {
  for (const FieldPart& part : parts)
    if (part.outline.name == field.name && part.outline.location == field.location) return &part;
  return nullptr;
}

}  // namespace

void serve_fields(const Distribution& distribution, const std::vector<FieldPart>& parts,
                  const mesh::Snapshot& outline,
                  const std::function<void(const mesh::FieldReader&)>& work) {
  const MPI_Comm comm = distribution.local().comm;
  if (rank_of(comm) != 0)
    for (;;) {
      const Request request = broadcast(comm, no_more);
      if (request[0] < 0) break;
      answer(distribution, parts[static_cast<std::size_t>(request[0])], request);
    }
  const mesh::FieldReader own = mesh::reader_of(outline);
  const mesh::FieldReader read = [&](const mesh::Field& field, std::size_t first,
                                     std::size_t last) {
    const FieldPart* part = find(parts, field);
    if (!part) return own(field, first, last);
    const Request request{part - parts.data(), static_cast<std::int64_t>(first),
                          static_cast<std::int64_t>(last)};
    return answer(distribution, *part, broadcast(comm, request));
  };
  on_root(comm, [&] {
    struct Release {  // the other ranks, also if `work` throws
      MPI_Comm comm;
      ~Release() { broadcast(comm, no_more); }
    } release{comm};
    work(read);
  });
}

void fill_fields(const Distribution& distribution, const std::vector<FieldPart>& parts,
                 mesh::Snapshot& outline) {
  constexpr std::size_t piece = 1 << 14;
  serve_fields(distribution, parts, outline, [&](const mesh::FieldReader& read) {
    for (mesh::Field& field : outline.fields) {
      const FieldPart* part = find(parts, field);
      if (!part) continue;
      const std::size_t owners = mesh::owner_count(outline, field);
      std::vector<double> values;
      values.reserve(owners * part->each);
      for (std::size_t first = 0; first < owners; first += piece) {
        const auto some = read(field, first, std::min(first + piece, owners));
        values.insert(values.end(), some.begin(), some.end());
      }
      field.values = std::move(values);
    }
  });
}

}  // namespace polyslip::solver
