// The keys of [loading].

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drivers/options_sections.hpp"
#include "solver/load_program.hpp"

namespace polyslip::drivers {

using core::Deck;

namespace {

const std::array<const char*, 6> face_names{"x0", "x1", "y0", "y1", "z0", "z1"};
const std::string axis_names = "xyz";

int read_axis(Deck::Table& t, const char* key, int fallback, const char* help) {
  const std::string name =
      t.text(key, {.fallback = axis_names.substr(static_cast<std::size_t>(fallback), 1),
                   .choices = {"x", "y", "z"},
                   .help = help});
  return name.empty() ? fallback : static_cast<int>(axis_names.find(name));
}

void read_directions(Deck::Table& t, solver::LoadingOptions& o) {
  o.axis = read_axis(t, "axis", o.axis,
                     "Direction of tension or compression; of simple shear the normal of the plane "
                     "that is sheared.");
  o.constrained_axis = read_axis(t, "constrained_axis", o.constrained_axis,
                                 "Plane strain: the direction that keeps its length.");
  o.direction = read_axis(t, "direction", o.direction, "Simple shear: the direction of shear.");
  o.lateral = t.text(
      "lateral",
      {.fallback = o.lateral,
       .choices = {"symmetry", "planar", "free"},
       .help =
           "Faces across the free directions of tension, compression or plane strain. symmetry: "
           "the low face is a symmetry plane, the high one free. planar: the same, but the high "
           "face stays flat with zero mean force. free: both free, rigid motions held at corner "
           "nodes."});
  const auto gradient = t.numbers(
      "velocity_gradient",
      {.fallback = std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 0},
       .help = "type = \"velocity-gradient\": L11, L12, L13, L21, ... L33, v_i = L_ij x_j, without "
               "trace. The whole boundary follows exp(L t); its shape counts, its size is "
               "such that sqrt(2/3 D:D) is strain_rate."});
  for (std::size_t i = 0; i < 9 && gradient.size() == 9; ++i)
    o.velocity_gradient(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) =
        gradient[i];
  if (gradient.size() != 9)
    t.fault("velocity_gradient", "velocity_gradient must have nine numbers");
}

void read_face(Deck::Table& t, std::size_t face, solver::LoadingOptions& o) {
  solver::FaceCondition& c = o.faces[face];
  const std::string name = face_names[face];
  c.kind = t.text(name, {.fallback = c.kind,
                         .choices = {"free", "sliding", "fixed", "moving", "planar"},
                         .help = "type = \"faces\": what is done to this face of the box. sliding: "
                                 "flat, free of shear, its normal velocity given; fixed: "
                                 "every node stays; moving: every node has the velocity given; "
                                 "planar: flat, free of shear, with the mean traction given."});
  c.velocity =
      t.vector3(name + "_velocity",
                {.unit = "L/s",
                 .fallback = std::vector<double>{0, 0, 0},
                 .help = "Velocity of a moving face; of a sliding one its normal component. "
                         "In a stage it is multiplied by the stage's rate over "
                         "[loading] strain_rate."});
  c.traction = t.number(name + "_traction",
                        {.unit = "MPa",
                         .fallback = 0.0,
                         .help = "Mean normal traction of a planar face; it pulls if positive."});
}

/// "x0y0z1:xy"
std::optional<solver::HeldCorner> corner_of(const std::string& text) {
  solver::HeldCorner c;
  if (text.size() < 8 || text.size() > 10 || text[6] != ':') return {};
  for (std::size_t i = 0; i < 3; ++i) {
    if (text[2 * i] != axis_names[i] || (text[2 * i + 1] != '0' && text[2 * i + 1] != '1'))
      return {};
    c.sides[i] = text[2 * i + 1] - '0';
  }
  for (std::size_t i = 7; i < text.size(); ++i) {
    const auto axis = axis_names.find(text[i]);
    if (axis == std::string::npos || c.components[axis]) return {};
    c.components[axis] = true;
  }
  return c;
}

void read_faces(Deck::Table& t, solver::LoadingOptions& o) {
  for (std::size_t face = 0; face < 6; ++face) read_face(t, face, o);
  for (const std::string& text :
       t.texts("held", {.fallback = std::vector<std::string>{},
                       .unique = true,
                       .help = "type = \"faces\": corner nodes that are held and the directions, "
                               "such as \"x0y0z0:xy\"."})) {
    if (const auto c = corner_of(text))
      o.held.push_back(*c);
    else
      t.fault("held", fmt::format("held: \"{}\" must name a corner and directions, such as "
                                  "\"x0y0z0:xy\"",
                                  text));
  }
  o.traction_strain =
      t.number("traction_strain",
               {.fallback = o.traction_strain,
                .min = 0,
                .exclusive_min = true,
                .help = "Strain over which mean tractions grow from zero to what is given."});
}

void read_targets(Deck::Table& t, solver::LoadingOptions& o) {
  o.strain_rate = t.number(
      "strain_rate",
      {.unit = "1/s",
       .fallback = o.strain_rate,
       .min = 0,
       .exclusive_min = true,
       .help = "Rate of the load's strain: the true strain rate; with control = "
               "\"constant-velocity\" the velocity over the initial height; of type = \"faces\" "
               "what makes a strain of the time (a time t is the strain strain_rate t)."});
  o.final_strain = t.number(
      "final_strain",
      {.fallback = o.final_strain,
       .min = 0,
       .exclusive_min = true,
       .max = 10,
       .help = "Strain at the end: ln(initial height/height) in compression, ln(height/initial "
               "height) in tension, the shear, or the integral of strain_rate."});
  o.final_time = t.optional_number("final_time",
                                   {.unit = "s",
                                    .min = 0,
                                    .exclusive_min = true,
                                    .help = "The run also ends at this time, if it comes first."});
  o.final_stress = t.optional_number(
      "final_stress",
      {.unit = "MPa",
       .min = 0,
       .exclusive_min = true,
       .help = "The run also ends when the load's stress comes to this, if that is first: the mean "
               "normal stress along the axis (positive in the sense of the load), the mean shear "
               "stress, or the von Mises stress of the mean."});
}

void read_steps(Deck::Table& t, solver::LoadingOptions& o) {
  o.max_strain_increment = t.number("max_strain_increment", {.fallback = o.max_strain_increment,
                                                             .min = 0,
                                                             .exclusive_min = true,
                                                             .max = 0.2,
                                                             .help = "Largest step."});
  o.initial_strain_increment = t.number(
      "initial_strain_increment",
      {.fallback = o.initial_strain_increment,
       .min = 0,
       .exclusive_min = true,
       .help = "First step from zero stress, at the start and after a remeshing, and of a stage; "
               "not more than max_strain_increment is taken."});
  o.increment_growth =
      t.number("increment_growth", {.fallback = o.increment_growth,
                                    .min = 1,
                                    .exclusive_min = true,
                                    .max = 10,
                                    .help = "Largest ratio of a step to the last."});
  o.min_strain_increment =
      t.number("min_strain_increment", {.fallback = o.min_strain_increment,
                                        .min = 0,
                                        .exclusive_min = true,
                                        .help = "A run whose steps have to be smaller than this "
                                                "stops, with a state to restart from."});
  o.fixed_increment = t.boolean(
      "fixed_increment",
      {.fallback = o.fixed_increment,
       .help = "Every step is max_strain_increment, or less to end at a strain that is asked for; "
               "for comparisons of runs step by step."});
  o.initial_strain_increment = std::min(o.initial_strain_increment, o.max_strain_increment);
}

void read_stage(Deck::Table& t, solver::LoadingOptions& o) {
  solver::LoadingStage s;
  s.strain_rate = t.number("strain_rate", {.unit = "1/s",
                                           .fallback = o.strain_rate,
                                           .help = "Rate in this stage; negative: backwards. A "
                                                   "target of strain gives the direction itself."});
  s.strain = t.optional_number("strain", {.help = "The load's strain at the end of the stage, "
                                                  "signed; below the last stage's: a reversal."});
  s.time = t.optional_number("time", {.unit = "s",
                                      .min = 0,
                                      .exclusive_min = true,
                                      .help = "Time of the run at the end of the stage."});
  s.stress = t.optional_number(
      "stress", {.unit = "MPa", .help = "The load's stress at the end of the stage, signed."});
  if (s.strain_rate == 0) t.fault("strain_rate", "strain_rate = 0 must not be 0");
  if (!s.strain && !s.time && !s.stress)
    t.fault("strain", "a stage needs a target: strain, time or stress");
  o.stages.push_back(s);
}

}  // namespace

solver::LoadingOptions read_loading(Deck& deck) {
  auto t = deck.table(
      "loading",
      "What is done to the box, and in which steps. A strain in the deck is the path of the load, "
      "the accumulated magnitude of its strain, which is its strain until a stage goes back.");
  solver::LoadingOptions o;
  o.type = t.text(
      "type",
      {.fallback = o.type,
       .choices = {"plane-strain-compression", "uniaxial-tension", "uniaxial-compression",
                   "simple-shear", "velocity-gradient", "faces"},
       .help = "The load. plane-strain-compression: along axis, faces across constrained_axis "
               "fixed; uniaxial-tension and -compression: along axis; faces that are not free "
               "slide. simple-shear, velocity-gradient: the whole boundary follows the homogeneous "
               "motion. faces: each face as its keys say."});
  o.control = t.text("control", {.fallback = o.control,
                                 .choices = {"true-strain-rate", "constant-velocity"},
                                 .help = "What strain_rate keeps constant in time: the true strain "
                                         "rate, or the velocity of the moving faces."});
  read_directions(t, o);
  read_targets(t, o);
  read_steps(t, o);
  read_faces(t, o);
  for (auto& stage :
       deck.tables("loading.stage",
                   "Stages of the load, one after another, instead of strain_rate, final_strain, "
                   "final_time and final_stress. A stage ends at the first of its targets that is "
                   "reached, and a new one starts with a small step."))
    read_stage(stage, o);
  return o;
}

}  // namespace polyslip::drivers
