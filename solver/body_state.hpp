#pragma once
// What a rank knows of the deforming body between steps, and the fields of a snapshot it comes from
// and goes to.

#include <vector>

#include "material/crystal_law.hpp"
#include "mesh/snapshot.hpp"
#include "solver/discretisation.hpp"
#include "solver/field_parts.hpp"
#include "solver/predictor.hpp"

namespace polyslip::solver {

/// After the last accepted step; stresses and volumes are empty before the first of a fresh body.
struct BodyState {
  Configuration now;
  std::vector<double> displacement;    ///< [local_nodes][3]
  std::vector<double> element_stress;  ///< [elements][6]
  std::vector<double> point_stress;    ///< [elements][points][6]
  std::vector<double> volumes;         ///< [elements]
};

/// How the body's numbers are laid out.
struct BodyLayout {
  const material::CrystalLaw& law;
  const PointRule& rule;
  bool mixed;
};

/// A field of rank 0's snapshot on this rank's nodes or elements; empty, on every rank, if there is
/// none. Collective.
std::vector<double> scatter_field(const Distribution& distribution, const mesh::Snapshot& snapshot,
                                  const std::string& name, mesh::Location location, int components);

/// Of a snapshot on rank 0. Collective.
BodyState read_body(const Distribution& distribution, const mesh::Snapshot& snapshot,
                    const BodyLayout& layout);

/// The fields of a snapshot, made on demand from what they are given here, which has to outlive
/// them. reference_volumes: [elements] of zero pressure.
std::vector<FieldPart> body_fields(const BodyState& body, const BodyLayout& layout,
                                   const LocalMesh& local,
                                   const std::vector<double>& reference_volumes,
                                   const Predictor& predictor);

}  // namespace polyslip::solver
