#pragma once
// Between a snapshot's fields (rank 0, entity by entity) and the solver's arrays (every rank, lane
// innermost).

#include <string>
#include <vector>

#include "material/crystal_law.hpp"
#include "mesh/snapshot.hpp"
#include "solver/reference_element.hpp"

namespace polyslip::solver {

/// Names of the fields and histories that only the solver reads.
namespace field {
inline const std::string displacement = "displacement";
inline const std::string reference_volume = "reference_volume";
inline const std::string volume = "volume";
inline const std::string pressure = "pressure";
inline const std::string cauchy_stress = "cauchy_stress";
inline const std::string partition = "partition";
inline const std::string volume_ratio = "volume_ratio";
inline const std::string rate = "solver_rate";
inline const std::string previous_rate = "solver_previous_rate";
inline const std::string pressure_rate = "solver_pressure_rate";
inline const std::string step_history = "solver_step";                // StepControl::history
inline const std::string predictor_steps = "solver_predictor_steps";  // Predictor::steps
inline const std::string load_program = "load_program";               // LoadProgram::history
inline const std::string partition_ranks = "solver_partition_ranks";  // {ranks}
}  // namespace field

/// Throws core::InternalError unless the snapshot has a mesh of order 2, so many points an element
/// and each state field of the law, of the right size.
void check_fields(const mesh::Snapshot& snapshot, const material::CrystalLaw& law, int points);

/// Index of component c of a point, or filling, `slot` in the law's state, which stands in blocks:
/// [elements][blocks][size][4], the last block of an element filled with repetitions of its last
/// point (solver/reference_element.hpp).
std::size_t state_index(const PointRule& rule, int size, std::size_t element, int c, int slot);
/// Components offset ... offset + components - 1 of such blocks at the points of the elements
/// first ... last - 1, appended: [elements][points][components].
void append_state(const PointRule& rule, int size, int offset, int components,
                  const std::vector<double>& blocks, std::size_t first, std::size_t last,
                  std::vector<double>& out);
/// The way back, for all elements.
void fill_state(const PointRule& rule, int size, int offset, int components,
                const std::vector<double>& values, std::vector<double>& blocks);

/// Values of a field; empty if there is none.
std::vector<double> values_of(const mesh::Snapshot& snapshot, const std::string& name,
                              mesh::Location location);

/// Whether the model makes this field anew for every snapshot.
bool is_of_model(const mesh::Field& field, const material::CrystalLaw& law);

/// Replaces the field of that name and location, or adds it.
void put(mesh::Snapshot& snapshot, mesh::Field field);

/// Numbers of points with those that fill blocks, [elements][slots], out of [elements][points].
std::vector<double> fill_slots(const std::vector<double>& values, const PointRule& rule);

/// The state fields out of blocks, put into the snapshot.
void put_state(mesh::Snapshot& snapshot, const material::CrystalLaw& law,
               const std::vector<double>& blocks);

}  // namespace polyslip::solver
