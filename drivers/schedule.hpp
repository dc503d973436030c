#pragma once
// The strains at which a run stops to store, to write a checkpoint or to remesh.

#include <vector>

namespace polyslip::drivers {

/// Strains closer than this are the same; far below any step, far above rounding.
inline constexpr double same_strain = 1e-9;

struct Event {
  double strain = 0;
  bool store = false, checkpoint = false, remesh = false, final = false;
};

/// In the order of strain, each strain once: output strains, both sides of each remeshing (with a
/// checkpoint), every `checkpoint_every` and the end (stored, with a checkpoint).
std::vector<Event> schedule(const std::vector<double>& output, const std::vector<double>& remeshing,
                            double checkpoint_every, double final_strain);

/// The first event beyond `strain`; null when none is left.
const Event* next_event(const std::vector<Event>& events, double strain);

/// The event at `strain`; null if there is none.
const Event* event_at(const std::vector<Event>& events, double strain);

}  // namespace polyslip::drivers
