// The keys of [taylor] and [texture].

#include <fmt/format.h>

#include <algorithm>

#include "drivers/options_sections.hpp"

namespace polyslip::drivers {

using core::Deck;

TaylorOptions read_taylor(Deck& deck) {
  auto t = deck.table("taylor",
                      "For `polyslip taylor`: each crystal deforms as the whole does, without a "
                      "mesh. Orientations, material, load and steps are those of a run.");
  TaylorOptions o;
  const auto count = t.optional_number(
      "orientations", {.min = 1,
                       .max = 1e8,
                       .help = "Number of random orientations, of the distribution and the seed of "
                               "the deck; if left out, those of the grains."});
  if (count && *count != static_cast<int>(*count))
    t.fault("orientations", fmt::format("orientations = {} must be a whole number", *count));
  if (count) o.orientations = static_cast<int>(*count);
  return o;
}

TextureOptions read_texture(Deck& deck) {
  auto t = deck.table("texture", "For `polyslip analyse`: how densities of orientations are made.");
  TextureOptions o;
  o.half_width = t.number(
      "half_width",
      {.unit = "degrees",
       .fallback = o.half_width,
       .min = 3,
       .max = 90,
       .help =
           "Of de la Vallee Poussin's kernel: the angle at which it is half its maximum. Narrow "
           "ones need many orientations."});
  o.sample_symmetry = t.text(
      "sample_symmetry",
      {.fallback = o.sample_symmetry,
       .choices = {"none", "orthorhombic"},
       .help = "Of maps and texture index. orthorhombic: densities are means over half turns "
               "about x, y and z."});
  return o;
}

void check_taylor(Deck& deck, const Options& o) {
  if (o.loading.type == "faces")
    deck.fault("loading", "type",
               "type = \"faces\" gives no velocity gradient; Taylor's model needs another type");
  const bool stress_target =
      o.loading.final_stress || std::any_of(o.loading.stages.begin(), o.loading.stages.end(),
                                            [](const auto& s) { return s.stress.has_value(); });
  if (stress_target)
    deck.fault("loading", "final_stress",
               "Taylor's model has no targets of stress; end the load by strain or time");
  const bool given =
      o.orientations.distribution == "file" || o.orientations.distribution == "input";
  if (o.taylor.orientations && given)
    deck.fault("taylor", "orientations",
               fmt::format("orientations are not drawn with distribution = \"{}\"; remove the key",
                           o.orientations.distribution));
}

}  // namespace polyslip::drivers
