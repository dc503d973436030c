// [orientations] and its components.

#include <fmt/format.h>

#include <optional>

#include "core/error.hpp"
#include "core/rotation.hpp"
#include "drivers/options_sections.hpp"

namespace polyslip::drivers {
namespace {

using core::Deck;
using core::TextureComponent;
using core::Vec3;

/// What a table of a component says, before it is a component.
struct ComponentKeys {
  std::string type;
  std::optional<std::string> name;
  std::vector<double> plane, direction, euler, crystal, sample;
};

std::vector<std::string> known_names() {
  std::vector<std::string> names;
  for (const auto& named : core::named_orientations()) names.push_back(named.name);
  return names;
}

std::vector<double> optional_triple(Deck::Table& t, const char* key, const char* unit,
                                    const char* help) {
  auto list = t.numbers(key, {.unit = unit, .fallback = std::vector<double>{}, .help = help});
  if (list.empty() || list.size() == 3) return list;
  t.fault(key, fmt::format("{} has {} numbers, must have three", key, list.size()));
  return {};
}

Vec3 vector_of(const std::vector<double>& list) { return {list[0], list[1], list[2]}; }

ComponentKeys read_keys(Deck::Table& t) {
  ComponentKeys k;
  k.type = t.text("type", {.fallback = "orientation",
                           .choices = {"orientation", "fibre", "uniform"},
                           .help = "Orientations about an ideal one (name, or plane and "
                                   "direction, or euler), about a fibre (crystal and sample), or "
                                   "uniform ones."});
  k.name = t.optional_text(
      "name", {.choices = known_names(),
               .help = "Ideal orientation, plane along z (ND) and direction along x (RD): cube "
                       "(001)[100], goss (011)[100], brass (011)[2-11], copper (112)[-1-11], s "
                       "(123)[63-4], dillamore (4 4 11)[11 11 -8], rotated-cube (001)[110]."});
  k.plane = optional_triple(t, "plane", "1", "h k l of the crystal's plane across z (ND).");
  k.direction =
      optional_triple(t, "direction", "1", "u v w of the crystal's direction along x (RD).");
  k.euler = optional_triple(t, "euler", "degrees", "phi1 Phi phi2 (Bunge) of the orientation.");
  k.crystal = optional_triple(t, "crystal", "1",
                              "Of a fibre: this direction of the crystal lies along sample.");
  k.sample = optional_triple(t, "sample", "1", "Of a fibre: direction in x (RD), y (TD), z (ND).");
  return k;
}

/// Notes a fault unless exactly the keys of one way to say it are there.
bool keys_agree(Deck::Table& t, const ComponentKeys& k) {
  const bool miller = !k.plane.empty() || !k.direction.empty();
  const bool fibre = !k.crystal.empty() || !k.sample.empty();
  const int ways = int{k.name.has_value()} + int{miller} + int{!k.euler.empty()};
  std::string what;
  if (k.type == "orientation" && (ways != 1 || fibre))
    what = "type = \"orientation\" needs one of name, plane with direction, and euler, and no more";
  else if (k.type == "orientation" && miller && (k.plane.empty() || k.direction.empty()))
    what = "plane and direction go together";
  else if (k.type == "fibre" && (k.crystal.empty() || k.sample.empty() || ways > 0))
    what = "type = \"fibre\" needs crystal and sample, and no name, plane, direction or euler";
  else if (k.type == "uniform" && (ways > 0 || fibre))
    what = "type = \"uniform\" goes without name, plane, direction, euler, crystal and sample";
  if (!what.empty()) t.fault("type", what);
  return what.empty();
}

core::Quaternion centre(const ComponentKeys& k) {
  if (!k.euler.empty()) return core::from_bunge(vector_of(k.euler));
  if (!k.plane.empty()) return core::miller_orientation(vector_of(k.plane), vector_of(k.direction));
  for (const auto& named : core::named_orientations())
    if (named.name == *k.name) return core::miller_orientation(named.plane, named.direction);
  throw core::InternalError("ideal orientation " + *k.name);
}

void set_kind(Deck::Table& t, const ComponentKeys& k, TextureComponent& c) {
  if (k.type == "uniform") return;
  if (k.type == "fibre") {
    c.kind = TextureComponent::Kind::fibre;
    c.crystal = vector_of(k.crystal);
    c.sample = vector_of(k.sample);
    for (const char* key : {"crystal", "sample"})
      if (!((std::string_view(key) == "crystal" ? c.crystal : c.sample).norm() > 0))
        t.fault(key, fmt::format("{} must not be zero", key));
    return;
  }
  c.kind = TextureComponent::Kind::orientation;
  try {
    c.orientation = centre(k);
  } catch (const core::InputError& e) {
    t.fault("plane", e.what());
  }
}

TextureComponent read_component(Deck::Table& t) {
  TextureComponent c;
  const ComponentKeys keys = read_keys(t);
  c.half_width =
      t.number("half_width",
               {.unit = "degrees",
                .fallback = 10,
                .min = 0,
                .max = 90,
                .help = "Spread: rotations by w with the density of de la Vallee Poussin's kernel, "
                        "cos^(2 kappa)(w/2), which is half its maximum at w = half_width; narrow "
                        "ones are normal about each axis, with the standard deviation "
                        "0.849 half_width. 0: none. Nothing for uniform ones."}) /
      core::degrees_per_radian;
  c.orthorhombic = t.text("sample_symmetry",
                          {.fallback = "none",
                           .choices = {"none", "orthorhombic"},
                           .help = "orthorhombic: half turns about x, y and z make four "
                                   "variants with a quarter of the share each."}) == "orthorhombic";
  c.share = t.number(
      "share", {.fallback = 1,
                .min = 0,
                .exclusive_min = true,
                .help = "Share of the volume, relative to those of the other components: that "
                        "share of the grains, whatever their volumes, in random order."});
  if (keys_agree(t, keys)) set_kind(t, keys, c);
  return c;
}

}  // namespace

OrientationOptions read_orientation_options(Deck& deck, const InputOptions& input) {
  auto t = deck.table("orientations", "Initial crystal orientations, one a grain.");
  OrientationOptions o;
  if (input.any()) o.distribution = "input";
  o.distribution =
      t.text("distribution", {.fallback = o.distribution,
                              .choices = {"uniform", "components", "file", "input"},
                              .help = "Uniform random orientations from the seed, those of the "
                                      "components, a file, or (the default with [polycrystal] "
                                      "file or [mesh] file) those of that file, uniform ones if "
                                      "it has none."});
  o.file = t.optional_file(
      "file",
      {.help = "With distribution = \"file\": one orientation a line, as many lines as "
               "grains; `#` starts a comment. A relative path starts at the deck's folder."});
  o.convention = t.text(
      "convention",
      {.fallback = o.convention,
       .choices = {"quaternion", "rodrigues", "euler-bunge"},
       .help =
           "What a line of the file holds: w x y z of a unit quaternion, r1 r2 r3 of a Rodrigues "
           "vector (both of the rotation that turns crystal axes into sample axes), or phi1 Phi "
           "phi2 in degrees (Bunge)."});
  for (Deck::Table& component :
       deck.tables("orientations.component",
                   "Where orientations gather, with distribution = \"components\": any number of "
                   "such tables, mixed by their shares. Orientations are drawn with the seed of "
                   "[polycrystal]."))
    o.components.push_back(read_component(component));
  return o;
}

}  // namespace polyslip::drivers
