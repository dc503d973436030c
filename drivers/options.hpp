#pragma once
// Everything a deck says, as one struct, and its reader.

#include <optional>
#include <string>
#include <vector>

#include "core/deck.hpp"
#include "core/texture.hpp"
#include "material/crystal_law.hpp"
#include "mesh/geometry.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/tessellation.hpp"
#include "remap/remesh.hpp"
#include "solver/options.hpp"

namespace polyslip::drivers {

/// What a deck asks for in [orientations].
struct OrientationOptions {
  std::string distribution = "uniform";            ///< "uniform", "components", "file" or "input"
  std::optional<std::string> file;                 ///< path to open; set if and only if "file"
  std::string convention = "quaternion";           ///< "quaternion", "rodrigues" or "euler-bunge"
  std::vector<core::TextureComponent> components;  ///< some if and only if "components"
};

/// A polycrystal or a mesh made elsewhere; at most one of them.
struct InputOptions {
  std::optional<std::string> tessellation;  ///< path of a .tess file, [polycrystal] file
  std::optional<std::string> mesh;          ///< path of a .msh file, [mesh] file
  std::optional<std::string> seeds;         ///< path of a file of seeds, [polycrystal] seeds
  mesh::LengthUnit length_unit = mesh::LengthUnit::grain;

  bool any() const { return tessellation || mesh; }
};

/// What a deck asks for in [taylor].
struct TaylorOptions {
  std::optional<int> orientations;  ///< random ones of the distribution; else those of the grains
};

/// What a deck asks for in [texture], for `polyslip analyse`.
struct TextureOptions {
  double half_width = 10;                ///< degrees
  std::string sample_symmetry = "none";  ///< or "orthorhombic"
};

/// What a deck asks for in [output].
struct OutputOptions {
  std::vector<double> at_strains;        ///< increasing, within [0, final_strain]
  double checkpoint_every_strain = 0.1;  ///< 0: at remeshings and the end only
  /// Of mesh files, mesh::mesh_format_names(); one of Gmsh's among them.
  std::vector<std::string> mesh_formats{"msh"};
  bool report = true;  ///< report.html at the end
};

struct Options {
  InputOptions input;
  mesh::PolycrystalOptions polycrystal;  ///< of a file: the seed alone counts
  mesh::RegularisationOptions regularisation;
  mesh::MeshingOptions mesh;
  OrientationOptions orientations;
  material::MaterialOptions material;
  solver::LoadingOptions loading;
  remap::RemeshingOptions remeshing;
  solver::SolverOptions solver;
  OutputOptions output;
  TaylorOptions taylor;
  TextureOptions texture;
};

/// What the deck is read for: a run needs elements of order 2, meshing alone does not, and Taylor's
/// model needs a load that gives a velocity gradient.
enum class Purpose { run, mesh, taylor };

/// Reads and checks the whole deck, and finishes it. InputError for the first fault, with its
/// place.
Options read_options(core::Deck& deck, Purpose purpose = Purpose::run);

/// docs/deck.md: the reference of every key, from the declarations.
std::string deck_reference();

}  // namespace polyslip::drivers
