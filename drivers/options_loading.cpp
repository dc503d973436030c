// The keys of [loading].

#include <algorithm>

#include "drivers/options_sections.hpp"

namespace polyslip::drivers {

using core::Deck;

solver::LoadingOptions read_loading(Deck& deck) {
  auto t = deck.table("loading", "What is done to the box, and in which steps.");
  solver::LoadingOptions o;
  o.type =
      t.text("type", {.fallback = o.type,
                      .choices = {"plane-strain-compression"},
                      .help = "Compression along z; y faces fixed in y, x0 a symmetry plane, x1 "
                              "free; all sliding."});
  o.strain_rate = t.number("strain_rate", {.unit = "1/s",
                                           .fallback = o.strain_rate,
                                           .min = 0,
                                           .exclusive_min = true,
                                           .help = "True strain rate, constant in time."});
  o.final_strain =
      t.number("final_strain", {.fallback = o.final_strain,
                                .min = 0,
                                .exclusive_min = true,
                                .max = 10,
                                .help = "Strain at the end, ln(initial height/height)."});
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
       .help = "First step from zero stress, at the start and after a remeshing; not more than "
               "max_strain_increment is taken."});
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
  return o;
}

}  // namespace polyslip::drivers
