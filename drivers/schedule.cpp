#include "drivers/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace polyslip::drivers {
namespace {

void merge(std::vector<Event>& events, const Event& event) {
  for (Event& e : events)
    if (std::abs(e.strain - event.strain) <= same_strain) {
      e.store |= event.store;
      e.checkpoint |= event.checkpoint;
      e.remesh |= event.remesh;
      e.final |= event.final;
      return;
    }
  events.push_back(event);
}

}  // namespace

std::vector<Event> schedule(const std::vector<double>& output, const std::vector<double>& remeshing,
                            double checkpoint_every, double final_strain) {
  // The first to name a strain fixes its digits: the end and the deck's own numbers come first.
  std::vector<Event> events;
  merge(events, {.strain = final_strain, .store = true, .checkpoint = true, .final = true});
  for (double strain : remeshing)
    merge(events, {.strain = strain, .store = true, .checkpoint = true, .remesh = true});
  for (double strain : output)
    if (strain > same_strain) merge(events, {.strain = strain, .store = true});
  if (checkpoint_every > 0)
    for (int i = 1; i * checkpoint_every < final_strain; ++i)
      merge(events, {.strain = i * checkpoint_every, .checkpoint = true});
  std::sort(events.begin(), events.end(),
            [](const Event& a, const Event& b) { return a.strain < b.strain; });
  return events;
}

const Event* next_event(const std::vector<Event>& events, double strain) {
  for (const Event& e : events)
    if (e.strain > strain + same_strain) return &e;
  return nullptr;
}

const Event* event_at(const std::vector<Event>& events, double strain) {
  for (const Event& e : events)
    if (std::abs(e.strain - strain) <= same_strain) return &e;
  return nullptr;
}

}  // namespace polyslip::drivers
