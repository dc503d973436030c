#pragma once
// Fields of the body of which each rank has its part, and how rank 0 reads them piece by piece.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "mesh/snapshot.hpp"
#include "solver/partition.hpp"

namespace polyslip::solver {

struct FieldPart {
  mesh::Field outline;   ///< the field without its values
  std::size_t each = 1;  ///< values of a node or element
  AppendRows append;
};

/// Runs `work` on rank 0 with a reader of these fields; the other ranks meanwhile send what it asks
/// for, so that no rank holds more of a field than its part and the piece that is read. A field
/// that is none of them is read from its own values. An exception of `work` is thrown on every
/// rank. Collective.
void serve_fields(const Distribution& distribution, const std::vector<FieldPart>& parts,
                  const mesh::Snapshot& outline,
                  const std::function<void(const mesh::FieldReader&)>& work);

/// Fills in the values of the fields that are among the parts. Collective.
void fill_fields(const Distribution& distribution, const std::vector<FieldPart>& parts,
                 mesh::Snapshot& outline);

}  // namespace polyslip::solver
