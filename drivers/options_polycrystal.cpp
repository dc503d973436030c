// [polycrystal]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "drivers/options_sections.hpp"
#include "mesh/polycrystal.hpp"

namespace polyslip::drivers {

namespace {

using core::Deck;
using mesh::Morphology;

constexpr const char* section = "polycrystal";

void read_shape(Deck& deck, Deck::Table& t, mesh::PolycrystalOptions& o) {
  o.shape = t.text(
      "shape",
      {.fallback = o.shape,
       .choices = {"box", "cylinder", "sphere", "half-spaces"},
       .help = "The body. Cylinders (elliptic ones too) and spheres (ellipsoids) are convex "
               "polyhedra whose facets touch the true body from outside. `polyslip run` takes a "
               "box only."});
  const bool by_planes = o.shape == "half-spaces";
  const char* instead = deck.given(section, "cells") ? "cells"
                        : by_planes                  ? "shape = \"half-spaces\""
                                                     : nullptr;
  if (counts(deck, section, "domain", instead))
    o.domain = t.vector3("domain",
                         {.fallback = std::vector<double>{1, 1, 1},
                          .min = 0,
                          .exclusive_min = true,
                          .help = "Extents of the body along x (RD), y (TD) and z (ND); only the "
                                  "ratios count. A thin sheet of n by n grains: [n, n, 1]."});
  const auto axis = t.optional_text(
      "axis", {.choices = {"x", "y", "z"},
               .help = "Axis of a cylinder, of columns and of bamboo; z if it is not given."});
  if (axis) o.axis = *axis == "x" ? 0 : *axis == "y" ? 1 : 2;
  const auto error = t.optional_number(
      "faceting_error",
      {.min = 1e-3,
       .max = 0.2,
       .help = "Largest excess of the volume of a faceted cylinder or sphere over that of the true "
               "body, which sets the number of facets; 0.01 if it is not given. Facets much "
               "smaller than a grain make small elements: the log says their size."});
  if (error) o.faceting_error = *error;
  const auto planes = t.optional_rows(
      "half_spaces", 4,
      {.help =
           "With shape = \"half-spaces\": [nx, ny, nz, d] for each plane, the body being where "
           "n . x <= d for all; n of any length. The body is scaled. Its faces are f1, f2, ..."});
  if (planes)
    for (const auto& p : *planes) o.half_spaces.push_back({p[0], p[1], p[2], p[3]});
}

void read_distributions(Deck::Table& t, mesh::GrainDistributions& o) {
  const auto read = [&t](const char* key, double& value, double least, double largest,
                         const char* help) {
    const auto given = t.optional_number(
        key,
        {.min = least, .exclusive_min = true, .max = largest, .exclusive_max = true, .help = help});
    if (given) value = *given;
  };
  read("diameter_deviation", o.diameter_deviation, 0, 1,
       "With morphology = \"laguerre\": standard deviation of the grains' equivalent diameters, "
       "lognormal, over their mean, which follows from the unit mean volume; 0.35 if it is not "
       "given.");
  read("sphericity_mean", o.sphericity_mean, 0.5, 0.95,
       "With morphology = \"laguerre\": mean sphericity (surface of the sphere of a grain's volume "
       "over the grain's surface); 0.855 if it is not given. One minus the sphericity is "
       "lognormal.");
  read("sphericity_deviation", o.sphericity_deviation, 0, 0.2,
       "With morphology = \"laguerre\": standard deviation of the sphericity; 0.03 if it is not "
       "given.");
}

void read_morphology(Deck::Table& t, mesh::PolycrystalOptions& o) {
  const auto& names = mesh::morphology_names();
  const std::string name = t.text(
      "morphology",
      {.fallback = names[static_cast<int>(o.morphology)],
       .choices = names,
       .help = "Voronoi cells of random seeds; columns along the axis; slabs across it; columns up "
               "to a share of the height and equiaxed grains above; cells of regular seeds; or "
               "Laguerre "
               "cells with asked distributions of grain size and sphericity (\"laguerre\": "
               "diameter_deviation, sphericity_mean and sphericity_deviation; \"grain-growth\": "
               "those of normal grain growth, 0.35, 0.855 and "
               "0.03). The log tells the distributions that were reached."});
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) o.morphology = static_cast<Morphology>(at - names.begin());
  o.stretch = t.vector3("stretch",
                        {.fallback = std::vector<double>{1, 1, 1},
                         .min = 0,
                         .exclusive_min = true,
                         .help = "Grains are longer by these factors along x, y and z, at the same "
                                 "volume; only the ratios count."});
  const auto share = t.optional_number(
      "columnar_share",
      {.min = 0,
       .exclusive_min = true,
       .max = 1,
       .exclusive_max = true,
       .help = "With morphology = \"columnar-equiaxed\": share of the height that "
               "columns take, from the low side of the axis; 0.5 if it is not "
               "given."});
  if (share) o.columnar_share = *share;
  read_distributions(t, o.distributions);
}

void read_periodic(Deck::Table& t, mesh::PolycrystalOptions& o) {
  for (const std::string& axis :
       t.texts("periodic",
               {.fallback = std::vector<std::string>{},
               .choices = {"x", "y", "z"},
               .unique = true,
               .help = "Directions in which the polycrystal, Voronoi cells of a box, repeats with "
                       "the box's period: grains are whole, and its outer faces there come in "
                       "pairs of translates whose meshes are translates too. For `polyslip "
                       "mesh`."}))
    o.periodic[static_cast<std::size_t>(axis[0] - 'x')] = true;
}

void read_cells(Deck& deck, Deck::Table& t, mesh::PolycrystalOptions& o) {
  const auto cells = t.optional_numbers(
      "cells", 3,
      {.min = 1,
       .max = 1000,
       .help =
           "With a regular morphology, instead of grains and domain: cubes of the grid of seeds "
           "along x, y and z. A cube holds 1 grain of morphology = \"cubes\", 2 "
           "\"truncated-octahedra\", 4 \"rhombic-dodecahedra\"."});
  if (!cells) return;
  std::array<int, 3> n{};
  for (int i = 0; i < 3; ++i) {
    n[i] = static_cast<int>((*cells)[i]);
    if (n[i] != (*cells)[i])
      return deck.fault(section, "cells",
                        fmt::format("cells: entry {} = {} must be an integer", i + 1, (*cells)[i]));
  }
  if (static_cast<double>(n[0]) * n[1] * n[2] > 250'000)
    return deck.fault(section, "cells", "cells: more than 250000 cubes");
  o.cells = n;
}

/// The number of grains of a regular grid, as soon as it is known.
void count_cells(mesh::PolycrystalOptions& o) {
  if (o.cells && mesh::is_regular(o.morphology))
    o.grains = static_cast<int>(mesh::regular_grain_count(o));
}

void unused(Deck& deck, const char* key, bool used, const std::string& with) {
  if (used || !deck.given(section, key)) return;
  deck.fault(section, key, fmt::format("{} is not used with {}; remove it", key, with));
}

void check_use(Deck& deck, const mesh::PolycrystalOptions& o, const InputOptions& input) {
  const std::string shape = fmt::format("shape = \"{}\"", o.shape);
  const std::string& name = mesh::morphology_names()[static_cast<int>(o.morphology)];
  const std::string morphology = fmt::format("morphology = \"{}\"", name);
  const bool along = o.shape == "cylinder" || o.morphology == Morphology::columnar ||
                     o.morphology == Morphology::bamboo ||
                     o.morphology == Morphology::columnar_equiaxed;
  unused(deck, "axis", along, shape + " and " + morphology);
  unused(deck, "faceting_error", o.shape == "cylinder" || o.shape == "sphere", shape);
  unused(deck, "half_spaces", o.shape == "half-spaces", shape);
  unused(deck, "columnar_share", o.morphology == Morphology::columnar_equiaxed, morphology);
  for (const char* key : {"diameter_deviation", "sphericity_mean", "sphericity_deviation"})
    unused(deck, key, o.morphology == Morphology::laguerre, morphology);
  // A deck as understood has the default, which stretches nothing.
  const bool stretched = o.stretch != core::Vec3::Constant(o.stretch[0]);
  unused(deck, "stretch", !stretched || !mesh::is_laguerre(o.morphology), morphology);
  unused(deck, "cells", mesh::is_regular(o.morphology), morphology);
  const bool periodic = o.periodic[0] || o.periodic[1] || o.periodic[2];
  if (o.shape != "box" || o.morphology != Morphology::voronoi) {
    const std::string with = o.shape != "box" ? shape : morphology;
    if (periodic)
      deck.fault(section, "periodic",
                 fmt::format("periodic polycrystals are Voronoi cells of a box, not of {}", with));
  } else if (periodic && stretched) {
    deck.fault(section, "periodic", "periodic is not used with stretch; remove one of them");
  }
  if (input.seeds && o.morphology != Morphology::voronoi)
    deck.fault(section, "morphology",
               fmt::format("{} is not used with seeds; remove one of them", morphology));
  if (o.shape == "half-spaces" && o.half_spaces.empty() && !deck.given(section, "half_spaces"))
    deck.fault(section, "shape", "shape = \"half-spaces\" needs the key half_spaces");
}

}  // namespace

bool counts(Deck& deck, const char* table, const char* key, const char* input) {
  if (!input) return true;
  if (!deck.given(table, key)) return false;
  deck.fault(table, key, fmt::format("{} is not used with {}; remove one of them", key, input));
  return true;
}

const char* mesh_input(const Deck& deck) {
  return deck.given("mesh", "file") ? "[mesh] file" : nullptr;
}

mesh::PolycrystalOptions read_polycrystal(Deck& deck, InputOptions& input) {
  auto t = deck.table(section,
                      "The polycrystal. Its body is scaled so that grains have unit mean volume, "
                      "which fixes the unit of every length of the deck and of the results.");
  mesh::PolycrystalOptions o;
  const char* made = mesh_input(deck);
  if (counts(deck, section, "file", made))
    input.tessellation = t.optional_file(
        "file",
        {.help =
             "A tessellation of a box made elsewhere, in Neper's format (`.tess`, version 3 and "
             "later, `.gz` too), instead of a new one: grains and domain are then the file's. "
             "It is scaled likewise. A relative path starts at the deck's folder."});
  if (!made && input.tessellation) made = "[polycrystal] file";
  const char* instead = made                           ? made
                        : deck.given(section, "seeds") ? "seeds"
                        : deck.given(section, "cells") ? "cells"
                                                       : nullptr;
  if (counts(deck, section, "grains", instead))
    o.grains = static_cast<int>(t.integer(
        "grains", {.fallback = o.grains, .min = 1, .max = 1'000'000, .help = "Number of grains."}));
  o.seed = static_cast<std::uint64_t>(t.integer(
      "seed", {.fallback = static_cast<std::int64_t>(o.seed),
               .min = 0,
               .help = "Same seed, same polycrystal and same uniform orientations, on any "
                       "number of threads and ranks."}));
  if (made) {
    bool given = false;
    for (const char* key : {"shape", "domain", "axis", "faceting_error", "half_spaces",
                            "morphology", "periodic", "stretch", "columnar_share", "cells", "seeds",
                            "diameter_deviation", "sphericity_mean", "sphericity_deviation"})
      if (deck.given(section, key)) {
        deck.fault(section, key,
                   fmt::format("{} is not used with {}; remove one of them", key, made));
        given = true;
      }
    if (!given) return o;
  }
  read_shape(deck, t, o);
  read_morphology(t, o);
  read_periodic(t, o);
  read_cells(deck, t, o);
  count_cells(o);
  input.seeds = t.optional_file(
      "seeds", {.help = "A file of seeds, x y z a line, `#` starting a comment, instead of random "
                        "ones: in the unit of domain, the body reaching from the origin to it, or "
                        "in that of half_spaces. There are as many grains as seeds. A relative "
                        "path starts at the deck's folder."});
  return o;
}

void check_polycrystal(Deck& deck, const mesh::PolycrystalOptions& o, const InputOptions& input) {
  if (input.any()) return;
  check_use(deck, o, input);
  if (input.seeds) {
    if (!std::filesystem::is_regular_file(*input.seeds))
      deck.fault(section, "seeds", fmt::format("{}: no such file", *input.seeds));
    return;
  }
  if (deck.given(section, "cells") && !o.cells) return;  // a fault that is known already
  if (mesh::is_laguerre(o.morphology) && o.grains < 2)
    deck.fault(section, "grains", "grains: a Laguerre polycrystal needs 2 grains or more");
  const char* key = o.shape == "half-spaces"         ? "half_spaces"
                    : mesh::is_regular(o.morphology) ? (o.cells ? "cells" : "grains")
                                                     : "domain";
  try {
    mesh::polycrystal_domain(o);
  } catch (const core::InputError& e) {
    if (!(o.shape == "half-spaces" && o.half_spaces.empty())) deck.fault(section, key, e.what());
  }
}

}  // namespace polyslip::drivers
