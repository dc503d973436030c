// What the keys of [loading] ask of each other.

#include <fmt/format.h>

#include <cmath>

#include "drivers/options_sections.hpp"
#include "solver/load_program.hpp"

namespace polyslip::drivers {

namespace {

using core::Deck;

const char* section = "loading";

bool one_of(const std::string& text, const std::vector<std::string>& list) {
  for (const auto& item : list)
    if (item == text) return true;
  return false;
}

/// Whether a key has another value than its default (a resolved deck has every key).
bool changed(const Deck& deck, const std::string& key) {
  for (const auto& d : deck.declarations())
    if (d.section == section && d.key == key) return d.value != d.fallback;
  return false;
}

/// A key that only some types of load read.
void check_use(Deck& deck, const solver::LoadingOptions& o, const std::string& key,
               const std::vector<std::string>& types) {
  if (changed(deck, key) && !one_of(o.type, types))
    deck.fault(section, key,
               fmt::format("{} is not used with type = \"{}\"; remove it", key, o.type));
}

void check_uses(Deck& deck, const solver::LoadingOptions& o) {
  const std::string psc = "plane-strain-compression", tension = "uniaxial-tension",
                    compression = "uniaxial-compression", shear = "simple-shear";
  check_use(deck, o, "axis", {psc, tension, compression, shear});
  check_use(deck, o, "lateral", {psc, tension, compression});
  check_use(deck, o, "constrained_axis", {psc});
  check_use(deck, o, "direction", {shear});
  check_use(deck, o, "velocity_gradient", {"velocity-gradient"});
  for (const char* key : {"held", "traction_strain"}) check_use(deck, o, key, {"faces"});
  for (const char* face : {"x0", "x1", "y0", "y1", "z0", "z1"})
    for (const char* end : {"", "_velocity", "_traction"})
      check_use(deck, o, std::string(face) + end, {"faces"});
}

void check_axes(Deck& deck, const solver::LoadingOptions& o) {
  if (o.type == "plane-strain-compression" && o.axis == o.constrained_axis)
    deck.fault(section, "constrained_axis", "constrained_axis must differ from axis");
  if (o.type == "simple-shear" && o.axis == o.direction)
    deck.fault(section, "direction", "direction must differ from axis");
  if (o.type != "velocity-gradient") return;
  const core::Mat3& l = o.velocity_gradient;
  if (!((l + l.transpose()).norm() > 1e-12 * l.norm()))
    deck.fault(section, "velocity_gradient", "velocity_gradient strains nothing: D = 0");
  else if (!(std::abs(l.trace()) <= 1e-9 * l.norm()))
    deck.fault(section, "velocity_gradient",
               fmt::format("velocity_gradient has the trace {:g}, must be 0: plastic flow keeps "
                           "volumes",
                           l.trace()));
  if (o.control != "true-strain-rate")
    deck.fault(section, "control", "velocity_gradient needs control = \"true-strain-rate\"");
}

void check_faces(Deck& deck, const solver::LoadingOptions& o) {
  if (o.type != "faces") return;
  const std::string names = "xyz";
  bool moves = false;
  std::array<bool, 3> stopped{};
  for (std::size_t face = 0; face < 6; ++face) {
    const auto& c = o.faces[face];
    const auto axis = static_cast<Eigen::Index>(face / 2);
    const std::string name = names.substr(face / 2, 1) + std::to_string(face % 2);
    core::Vec3 tangential = c.velocity;
    tangential[axis] = 0;
    if (c.velocity != core::Vec3::Zero() && c.kind != "moving" && c.kind != "sliding")
      deck.fault(section, name + "_velocity",
                 fmt::format("{0}_velocity is for {0} = \"sliding\" or \"moving\"", name));
    else if (c.kind == "sliding" && tangential != core::Vec3::Zero())
      deck.fault(section, name + "_velocity",
                 fmt::format("{0}_velocity: a sliding face has a normal velocity only; set {0} = "
                             "\"moving\"",
                             name));
    if (c.traction != 0 && c.kind != "planar")
      deck.fault(section, name + "_traction",
                 fmt::format("{0}_traction is for {0} = \"planar\"", name));
    moves = moves || c.velocity != core::Vec3::Zero() || c.traction != 0;
    for (Eigen::Index i = 0; i < 3; ++i)
      if (c.kind == "fixed" || c.kind == "moving" || (c.kind == "sliding" && i == axis))
        stopped[static_cast<std::size_t>(i)] = true;
  }
  for (const auto& c : o.held)
    for (std::size_t i = 0; i < 3; ++i) stopped[i] = stopped[i] || c.components[i];
  if (!moves) deck.fault(section, "type", "type = \"faces\": no face has a velocity or a traction");
  for (std::size_t i = 0; i < 3; ++i)
    if (!stopped[i])
      deck.fault(section, "type",
                 fmt::format("type = \"faces\": nothing holds the box along {}; fix a face or hold "
                             "a corner",
                             names[i]));
}

void check_stages(Deck& deck, const solver::LoadingOptions& o) {
  if (o.stages.empty()) return;
  for (const char* key : {"final_strain", "final_time", "final_stress"})
    if (changed(deck, key))
      deck.fault(section, key,
                 fmt::format("{} is not used with [[loading.stage]]; remove it", key));
  double strain = 0, time = 0;
  solver::LoadProgram program(o);
  for (std::size_t i = 0; i < o.stages.size(); ++i) {
    const auto& s = o.stages[i];
    const std::string name = fmt::format("loading.stage {}", i + 1);
    if (s.strain && s.strain_rate < 0 && *s.strain > strain)
      deck.fault(name, "strain",
                 fmt::format("strain = {} lies ahead of {}, but strain_rate is negative", *s.strain,
                             strain));
    if (s.time && !(*s.time > time))
      deck.fault(name, "time",
                 fmt::format("time = {} must be > {}, the end of the stage before", *s.time, time));
    const double start = program.finished() ? 0 : program.stage_end();
    program.advance(start, false);
    strain = program.strain(start);
    time = program.time(start);
  }
  if (!(solver::LoadProgram(o).planned_end() > 0))
    deck.fault("loading.stage 1", "strain", "the stages do not strain anything");
}

}  // namespace

void check_loading(Deck& deck, const solver::LoadingOptions& o) {
  if (!(o.min_strain_increment < o.initial_strain_increment))
    deck.fault(section, "min_strain_increment",
               fmt::format("min_strain_increment = {} must be below the first step, {}",
                           o.min_strain_increment, o.initial_strain_increment));
  check_uses(deck, o);
  check_axes(deck, o);
  check_faces(deck, o);
  check_stages(deck, o);
}

}  // namespace polyslip::drivers
