#include "drivers/options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/options_check.hpp"
#include "drivers/options_sections.hpp"
#include "drivers/orientations.hpp"
#include "mesh/mesh_formats.hpp"
#include "mesh/polycrystal.hpp"

namespace polyslip::drivers {

namespace {

using core::Deck;

mesh::RegularisationOptions read_regularisation(Deck& deck, const InputOptions& input) {
  auto t = deck.table("regularisation",
                      "Removal of short edges of the tessellation (section 2.1.2 of the paper).");
  mesh::RegularisationOptions o;
  if (const char* made = mesh_input(deck)) {
    bool given = false;
    for (const char* key : {"max_edge_length", "max_flatness_fault", "polyline_share",
                            "min_corner_angle", "position_search", "flattening_sweeps"})
      given |= counts(deck, "regularisation", key, made);
    if (!given) return o;
  }
  if (input.tessellation) o.max_edge_length = 0;
  o.max_edge_length =
      t.number("max_edge_length", {.unit = "length",
                                   .fallback = o.max_edge_length,
                                   .min = 0,
                                   .max = 1,
                                   .help = "l_max: edges shorter than this are removed where "
                                           "flatness allows; 0 removes none, and is the "
                                           "default for a tessellation from a file."});
  o.max_flatness_fault =
      t.number("max_flatness_fault", {.unit = "degrees",
                                      .fallback = o.max_flatness_fault,
                                      .min = 0,
                                      .max = 90,
                                      .exclusive_max = true,
                                      .help = "f_max: largest angle between the normals of the "
                                              "triangles that make a face."});
  o.polyline_share = t.number(
      "polyline_share",
      {.fallback = o.polyline_share,
       .min = 0,
       .max = 1,
       .help =
           "Edges shorter than this share of max_edge_length are removed even where two faces "
           "of a grain then share a polyline of two edges. 0, with min_corner_angle = 0: never. "
           "The paper's regularisation has 0, 0, and 1 and 0 in the next two keys."});
  o.min_corner_angle = t.number(
      "min_corner_angle",
      {.unit = "degrees",
       .fallback = o.min_corner_angle,
       .min = 0,
       .max = 90,
       .exclusive_max = true,
       .help = "So are edges of any length opposite to a corner of a triangular face that is "
               "sharper than this: meshes are worst at acute corners. 0: none."});
  o.position_search = t.number(
      "position_search",
      {.fallback = o.position_search,
       .min = 1,
       .max = 4,
       .help = "Where the paper's position of a new vertex leaves a flatness fault above "
               "max_flatness_fault, but not above this times it, a better one is sought nearby; "
               "1: never."});
  o.flattening_sweeps = static_cast<int>(t.integer(
      "flattening_sweeps",
      {.fallback = o.flattening_sweeps,
       .min = 0,
       .max = 10,
       .help = "So many times, once no more edge can be removed, vertices move to where their "
               "faces are flatter; then removal goes on. 0: never."}));
  return o;
}

mesh::MeshingOptions read_mesh(Deck& deck, InputOptions& input) {
  auto t = deck.table("mesh", "The finite-element mesh, the first one and those of remeshings.");
  mesh::MeshingOptions o;
  input.mesh = t.optional_file(
      "file",
      {.help =
           "The first mesh, made elsewhere, in Gmsh's format 2.2 or 4.1 (`.msh`, ASCII or binary, "
           "`.gz` too), grains as physical volumes, of a box; its grains' faces, edges and "
           "vertices are found from "
           "them. [polycrystal] and [regularisation] then have no meaning, but for the seed of "
           "uniform orientations. The other keys here are those of remeshings. A relative path "
           "starts at the deck's folder."});
  const std::string unit = t.text(
      "length_unit",
      {.fallback = "grain",
       .choices = {"grain", "file"},
       .help = "With a mesh from a file: lengths of the deck and of the results are for grains of "
               "unit mean volume, to which the mesh is scaled, or in the file's unit."});
  input.length_unit = unit == "file" ? mesh::LengthUnit::file : mesh::LengthUnit::grain;
  o.element_size = t.number("element_size", {.unit = "length",
                                             .fallback = o.element_size,
                                             .min = 0.01,
                                             .max = 10,
                                             .help = "c_l: length of element edges."});
  o.outer_element_size = t.optional_number(
      "element_size_outer", {.unit = "length",
                             .min = 0.01,
                             .max = 10,
                             .help = "c_l of grains with a face on the domain boundary; if left "
                                     "out, that of all."});
  o.grain_element_sizes =
      t.numbers("grain_element_sizes", {.unit = "length",
                                        .fallback = o.grain_element_sizes,
                                        .min = 0.01,
                                        .max = 10,
                                        .help = "c_l of each grain, in the order of their numbers; "
                                                "if left out, the two keys above."});
  o.progression_factor =
      t.number("progression_factor", {.fallback = o.progression_factor,
                                      .min = 1,
                                      .max = 100,
                                      .help = "p_l: largest ratio of the lengths of neighbouring "
                                              "elements on an edge."});
  o.order = static_cast<int>(t.integer(
      "order", {.fallback = o.order,
                .min = 1,
                .max = 2,
                .help = "Order of the elements: 2 for a run; 1 may be asked of `polyslip mesh`."}));
  o.meshers =
      t.texts("meshers", {.fallback = o.meshers,
                          .choices = {mesh::known_meshers.begin(), mesh::known_meshers.end()},
                          .unique = true,
                          .not_empty = true,
                          .help = "Meshers to try on each grain; the best mesh wins. Those "
                                  "after the first are tried on grains that miss a stated "
                                  "quality so far. `gmsh-hxt`, `gmsh-delaunay` and `netgen` "
                                  "are followed by our optimiser, the others not: "
                                  "`paper-1` and `paper-2` are those of the paper."});
  o.face_meshers = t.texts(
      "face_meshers",
      {.fallback = o.face_meshers,
       .choices = {mesh::known_face_meshers.begin(), mesh::known_face_meshers.end()},
       .unique = true,
       .not_empty = true,
       .help = "Meshers to try on each face; those after the first where the worst triangle so "
               "far is below what the face's corners allow. `own` is ours, the others are Gmsh's "
               "frontal-Delaunay and Delaunay."});
  o.mesher_target = t.number(
      "mesher_target", {.fallback = o.mesher_target,
                        .min = 0,
                        .exclusive_min = true,
                        .max = 1,
                        .help = "Meshers after the first try a grain only if its worst element so "
                                "far is below what its surface allows, or O below this share of "
                                "it; with 1 each mesher tries each grain, as in the paper."});
  o.slide_boundary = t.boolean(
      "slide_boundary", {.fallback = o.slide_boundary,
                         .help = "Whether nodes of grain boundaries slide in their faces and along "
                                 "their edges to where the elements on all sides are best, and "
                                 "grains are optimised once more."});
  o.mesher_timeout = t.number("mesher_timeout",
                              {.unit = "s",
                               .fallback = o.mesher_timeout,
                               .min = 1,
                               .max = 86400,
                               .help = "CPU time a mesher may spend on one grain; beyond it that "
                                       "candidate is lost, and the log says so."});
  return o;
}

void read_wear(Deck::Table& t, remap::RemeshingOptions& o) {
  remap::WearOptions& w = o.wear;
  w.radius_ratio_share = t.number(
      "radius_ratio_share",
      {.fallback = w.radius_ratio_share,
       .min = 0,
       .max = 1,
       .exclusive_max = true,
       .help =
           "The mesh is worn when its worst radius ratio, in the frame of sizes (docs/theory.md), "
           "is below this share of what it was when the mesh was new; 0: never."});
  w.jacobian_share = t.number(
      "jacobian_share",
      {.fallback = w.jacobian_share,
       .min = 0,
       .max = 1,
       .exclusive_max = true,
       .help = "Likewise for the worst scaled Jacobian, det J of an element over its mean, at "
               "corners and quadrature points; 0: not before one is negative."});
  w.poor_radius_ratio = t.number("poor_radius_ratio",
                                 {.fallback = w.poor_radius_ratio,
                                  .min = 0,
                                  .max = 1,
                                  .help = "An element whose radius ratio, in that frame, is below "
                                          "this is poor."});
  w.poor_share_increase = t.number(
      "poor_share_increase",
      {.fallback = w.poor_share_increase,
       .min = 0,
       .max = 1,
       .help = "The mesh is worn when the share of poor elements has grown by more than this; 1: "
               "never."});
  w.inversion_strain = t.number(
      "inversion_strain",
      {.fallback = w.inversion_strain,
       .min = 0,
       .max = 1,
       .help = "The mesh is worn when an element would invert within this strain, were nodes to go "
               "on as in the last step; 0: never."});
  o.min_interval = t.number(
      "min_interval",
      {.fallback = o.min_interval,
       .min = 0,
       .max = 10,
       .help =
           "No worn elements are looked for within this strain after a remeshing, or before one of "
           "at_strains or the end."});
}

void read_transport(Deck::Table& t, remap::RemeshingOptions& o) {
  o.transport.state = t.text(
      "transport",
      {.fallback = o.transport.state,
       .choices = {"element", "point", "corrected"},
       .help =
           "How the state goes to the new mesh, within each grain. element: the mean of the old "
           "element that holds a new one's centroid (the paper); point: for each quadrature "
           "point, the nearest point of the old element that holds the part of the new one for "
           "which it stands; corrected: the same, and "
           "each grain gets its mean orientation, its spread and its mean g and slip back."});
  o.transport.stress = t.text(
      "stress", {.fallback = o.transport.stress,
                 .choices = {"zero", "carried"},
                 .help = "Stresses after a remeshing: zero (the paper) but for each grain's mean "
                         "pressure, without which its elastic compression would be lost volume; or "
                         "carried over like the state and brought to equilibrium with the "
                         "boundary held."});
  o.max_grain_rotation = t.number(
      "max_grain_rotation", {.unit = "degrees",
                             .fallback = o.max_grain_rotation,
                             .min = 0,
                             .exclusive_min = true,
                             .max = 180,
                             .help = "Largest rotation of a grain's mean orientation by a "
                                     "remeshing; beyond it the run stops and names the grain."});
  o.max_grain_spread_change =
      t.number("max_grain_spread_change",
               {.unit = "degrees",
                .fallback = o.max_grain_spread_change,
                .min = 0,
                .exclusive_min = true,
                .max = 180,
                .help = "Likewise of a grain's spread, the mean angle from its mean orientation."});
  o.max_grain_g_change =
      t.number("max_grain_g_change", {.fallback = o.max_grain_g_change,
                                      .min = 0,
                                      .exclusive_min = true,
                                      .max = 1,
                                      .help = "Likewise of a grain's mean slip resistance g, "
                                              "relative."});
}

remap::RemeshingOptions read_remeshing(Deck& deck) {
  auto t = deck.table("remeshing", "When the deformed polycrystal gets a new mesh (section 2.3).");
  remap::RemeshingOptions o;
  o.automatic = t.boolean(
      "automatic",
      {.fallback = o.automatic,
       .help = "Whether to remesh when elements are worn, as the keys below say, or when no step "
               "converges; false: at the given strains only."});
  o.at_strains =
      t.numbers("at_strains", {.fallback = std::vector<double>{},
                               .min = 0,
                               .exclusive_min = true,
                               .increasing = true,
                               .help = "Strains at which to remesh; below final_strain."});
  read_wear(t, o);
  o.orthotropic_share = t.number(
      "orthotropic_share",
      {.fallback = o.orthotropic_share,
       .min = 0,
       .max = 1,
       .help = "Share of the shortening that element sizes follow: 1 keeps the number of elements "
               "across a direction in which the polycrystal was compressed, 0 keeps their size."});
  o.lengthening_share = t.number(
      "lengthening_share",
      {.fallback = o.lengthening_share,
       .min = 0,
       .max = 1,
       .help = "Share of the lengthening that element sizes follow: 0 keeps their size along a "
               "direction in which the polycrystal was drawn out, 1 the number of elements."});
  read_transport(t, o);
  o.max_grain_volume_change = t.number("max_grain_volume_change",
                                       {.fallback = o.max_grain_volume_change,
                                        .min = 0,
                                        .exclusive_min = true,
                                        .max = 1,
                                        .help = "Largest relative change of a grain's volume in a "
                                                "remeshing; beyond it the run stops and names the "
                                                "grain."});
  return o;
}

OutputOptions read_output(Deck& deck) {
  auto t = deck.table("output", "Which states are kept.");
  OutputOptions o;
  o.at_strains = t.numbers(
      "at_strains", {.fallback = std::vector<double>{},
                     .min = 0,
                     .increasing = true,
                     .help = "Strains at which a state is stored, besides the start, the end "
                             "and both sides of each remeshing."});
  o.checkpoint_every_strain = t.number(
      "checkpoint_every_strain",
      {.fallback = o.checkpoint_every_strain,
       .min = 0,
       .help = "A checkpoint to restart from at every multiple of this strain, besides the "
               "end and both sides of each remeshing; 0: at those only."});
  o.mesh_formats = t.texts(
      "mesh_formats",
      {.fallback = o.mesh_formats,
       .choices = mesh::mesh_format_names(),
       .unique = true,
       .not_empty = true,
       .help = "Files of each mesh, mesh-000.msh and so on: Gmsh's format 2.2 (msh, msh-binary) or "
               "4.1 (msh4, msh4-binary), one of these; vtu for ParaView; inp for Abaqus. "
               "docs/formats.md says what they hold."});
  o.report =
      t.boolean("report", {.fallback = o.report,
                           .help = "Whether a run ends with report.html, one page that shows "
                                   "it (docs/report.md)."});
  return o;
}

Options declare(Deck& deck) {
  Options o;
  o.polycrystal = read_polycrystal(deck, o.input);
  o.regularisation = read_regularisation(deck, o.input);
  o.mesh = read_mesh(deck, o.input);
  o.orientations = read_orientation_options(deck, o.input);
  o.material = read_material(deck);
  o.loading = read_loading(deck);
  o.remeshing = read_remeshing(deck);
  o.solver = read_solver(deck);
  o.output = read_output(deck);
  o.taylor = read_taylor(deck);
  o.texture = read_texture(deck);
  return o;
}

}  // namespace

Options read_options(Deck& deck, Purpose purpose) {
  Options options = declare(deck);
  check_options(deck, options, purpose);
  deck.finish();
  if (options.input.seeds) mesh::read_seeds(*options.input.seeds, options.polycrystal);
  // Its faults show before any work; of an input file the number of grains is not known yet.
  if (options.orientations.file && !options.input.any()) grain_orientations(options);
  return options;
}

std::string deck_reference() {
  // One of each list, so that its keys are declared.
  Deck deck = Deck::from_text("[[orientations.component]]\n[[loading.stage]]\n", "deck.toml");
  declare(deck);
  return "# The deck\n\n"
         "A deck is a TOML file. This page is generated from the program "
         "(`build/polyslip reference > docs/deck.md`);\na test fails when it is stale. Every key "
         "has "
         "a "
         "default, an unknown key or table is an error,\nand the run folder keeps the deck as "
         "given "
         "and, in `deck.resolved.toml`, with every default.\n\n"
         "Lengths are for grains of unit mean volume: a grain is about 1.24 across (a mesh from a "
         "file may\nkeep its unit). Strains are true\n"
         "strains along z, ln(initial height/height). Axes: x is RD, y is TD, z is ND, the "
         "direction\n"
         "of compression. An integer will do where a number is asked.\n\n" +
         deck.reference();
}

}  // namespace polyslip::drivers
