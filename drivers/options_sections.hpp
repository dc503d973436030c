#pragma once
// Readers of single tables of the deck, each in a file of its own; read_options calls them.

#include "core/deck.hpp"
#include "drivers/options.hpp"
#include "material/crystal_law.hpp"
#include "solver/options.hpp"

namespace polyslip::drivers {

OrientationOptions read_orientation_options(core::Deck& deck, const InputOptions& input);
material::MaterialOptions read_material(core::Deck& deck);
solver::LoadingOptions read_loading(core::Deck& deck);
solver::SolverOptions read_solver(core::Deck& deck);

/// Notes what the keys of [loading] ask of each other and the deck does not give.
void check_loading(core::Deck& deck, const solver::LoadingOptions& options);

}  // namespace polyslip::drivers
