#include "drivers/options_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "drivers/options_sections.hpp"
#include "solver/load_program.hpp"

namespace polyslip::drivers {

namespace {

using core::Deck;

/// "g0 = 8 (deck.toml:12:6)", or "g0 = 8 (default)".
std::string with_place(const Deck& deck, const std::string& section, const std::string& key,
                       double value) {
  const std::string place = deck.given(section, key) ? deck.where(section, key) : "default";
  return fmt::format("{} = {} ({})", key, value, place);
}

void check_file(Deck& deck, const char* section, const std::string& path) {
  if (!std::filesystem::exists(path))
    deck.fault(section, "file", fmt::format("{}: no such file", path));
  else if (!std::filesystem::is_regular_file(path))
    deck.fault(section, "file", fmt::format("{}: is not a file", path));
}

void check_orientations(Deck& deck, const OrientationOptions& o) {
  const char* section = "orientations";
  if (o.distribution != "file" && o.file)
    deck.fault(section, "file",
               fmt::format("file is not used with distribution = \"{}\"; remove it, or set "
                           "distribution = \"file\"",
                           o.distribution));
  if (o.distribution == "components" && o.components.empty())
    deck.fault(section, "distribution",
               "distribution = \"components\" needs a table [[orientations.component]] at least");
  if (o.distribution != "components" && !o.components.empty())
    deck.fault("orientations.component 1", "",
               fmt::format("components are not used with distribution = \"{}\"; remove them, or "
                           "set distribution = \"components\"",
                           o.distribution));
  if (o.distribution != "file") return;
  if (!o.file)
    deck.fault(section, "distribution", "distribution = \"file\" needs the key file");
  else
    check_file(deck, section, *o.file);
}

void check_input(Deck& deck, const Options& o) {
  if (o.input.tessellation) check_file(deck, "polycrystal", *o.input.tessellation);
  if (o.input.mesh) check_file(deck, "mesh", *o.input.mesh);
  if (o.orientations.distribution == "input" && !o.input.any())
    deck.fault("orientations", "distribution",
               "distribution = \"input\" needs a file in [polycrystal] or [mesh]");
}

void check_material(Deck& deck, const material::MaterialOptions& o) {
  const char* section = "material";
  if (!(o.c11 > o.c12))
    deck.fault(section, "c11",
               fmt::format("c11 = {} must be > {}: the crystal would be unstable in shear", o.c11,
                           with_place(deck, section, "c12", o.c12)));
  if (!(o.c11 + 2 * o.c12 > 0))
    deck.fault(section, "c12",
               fmt::format("c12 = {} must be > -c11/2, {}: the bulk modulus would not be positive",
                           o.c12, with_place(deck, section, "c11", o.c11)));
  if (o.h0 > 0 ? !(o.gs > o.g0) : !(o.gs >= o.g0))
    deck.fault(section, "gs",
               fmt::format("gs = {} must be {} {}{}", o.gs,
                           o.h0 > 0 ? ">" : ">=", with_place(deck, section, "g0", o.g0),
                           o.h0 > 0 && o.gs == o.g0 ? "; for no hardening set h0 = 0" : ""));
}

void check_strains(Deck& deck, const Options& o) {
  const double end = solver::LoadProgram(o.loading).planned_end();
  const std::string final_strain = end == o.loading.final_strain && o.loading.stages.empty()
                                       ? with_place(deck, "loading", "final_strain", end)
                                       : fmt::format("the end of the load, {:.6g}", end);
  for (const double strain : o.remeshing.at_strains)
    if (!(strain < end)) {
      deck.fault("remeshing", "at_strains",
                 fmt::format("at_strains: {} must be < {}", strain, final_strain));
      break;
    }
  for (const double strain : o.output.at_strains)
    if (!(strain <= end)) {
      deck.fault("output", "at_strains",
                 fmt::format("at_strains: {} must be <= {}", strain, final_strain));
      break;
    }
}

/// Files of one name must not be written over each other, and what reads a folder needs one.
void check_mesh_formats(Deck& deck, const std::vector<std::string>& formats) {
  const auto gmsh = std::count_if(formats.begin(), formats.end(),
                                  [](const std::string& f) { return f.starts_with("msh"); });
  if (gmsh != 1)
    deck.fault("output", "mesh_formats",
               fmt::format("mesh_formats names {} of Gmsh's formats; must be one of msh, "
                           "msh-binary, msh4 and msh4-binary, and any others",
                           gmsh));
}

}  // namespace

void check_options(Deck& deck, const Options& options, Purpose purpose) {
  check_input(deck, options);
  check_polycrystal(deck, options.polycrystal, options.input);
  check_orientations(deck, options.orientations);
  const auto sizes = options.mesh.grain_element_sizes.size();
  if (sizes != 0 && !options.input.any() &&
      sizes != static_cast<std::size_t>(options.polycrystal.grains))
    deck.fault("mesh", "grain_element_sizes",
               fmt::format("grain_element_sizes: {} numbers for {} grains; give one a grain", sizes,
                           options.polycrystal.grains));
  check_material(deck, options.material);
  check_loading(deck, options.loading);
  check_strains(deck, options);
  check_mesh_formats(deck, options.output.mesh_formats);
  if (purpose == Purpose::taylor) check_taylor(deck, options);
  if (purpose == Purpose::run && options.polycrystal.shape != "box")
    deck.fault(
        "polycrystal", "shape",
        fmt::format("shape = \"{}\" is for `polyslip mesh` only: loads act on the faces of a "
                    "box",
                    options.polycrystal.shape));
  const auto& periodic = options.polycrystal.periodic;
  if (purpose == Purpose::run && (periodic[0] || periodic[1] || periodic[2]))
    deck.fault("polycrystal", "periodic",
               "periodic is for `polyslip mesh` only: there are no periodic loads; remove it");
  if (purpose == Purpose::run && options.mesh.order != 2)
    deck.fault("mesh", "order",
               fmt::format("order = {} is for `polyslip mesh` only; a run needs order = 2",
                           options.mesh.order));
}

}  // namespace polyslip::drivers
