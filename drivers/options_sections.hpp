#pragma once
// Readers of single tables of the deck, each in a file of its own; read_options calls them.

#include "core/deck.hpp"
#include "drivers/options.hpp"
#include "material/crystal_law.hpp"
#include "solver/options.hpp"

namespace polyslip::drivers {

/// Whether a key has a meaning beside an input file. One that has none is declared only if the deck
/// gives it, which is a fault, so that the resolved deck does without.
bool counts(core::Deck& deck, const char* section, const char* key, const char* input);
/// "[mesh] file" if the deck has it, else null.
const char* mesh_input(const core::Deck& deck);

mesh::PolycrystalOptions read_polycrystal(core::Deck& deck, InputOptions& input);
/// Notes faults between the keys of [polycrystal]; `seeds` is its file of seeds.
void check_polycrystal(core::Deck& deck, const mesh::PolycrystalOptions& options,
                       const InputOptions& input);
OrientationOptions read_orientation_options(core::Deck& deck, const InputOptions& input);
material::MaterialOptions read_material(core::Deck& deck);
solver::LoadingOptions read_loading(core::Deck& deck);
solver::SolverOptions read_solver(core::Deck& deck);
TaylorOptions read_taylor(core::Deck& deck);
TextureOptions read_texture(core::Deck& deck);

/// Notes what Taylor's model asks of the deck.
void check_taylor(core::Deck& deck, const Options& options);

/// Notes what the keys of [loading] ask of each other and the deck does not give.
void check_loading(core::Deck& deck, const solver::LoadingOptions& options);

}  // namespace polyslip::drivers
