// Bodies one after the other, found anew when anything came or went.
#include "sim/motion_hash.h"

#include "base/hash.h"
#include "sim/world.h"

namespace limber {

void MotionHash::find(const Store& store) {
  structure_ = store.structure_version();
  places_.clear();
  parts_.clear();
  const auto place = [&](NodeId id) { return static_cast<std::uint32_t>(store.live_block(id) - store.live().data()); };
  for (const auto& body : world_.bodies()) {
    for (const auto& part : body->parts()) parts_.push_back(place(part->id()));
    places_.push_back({place(body->id()), static_cast<std::uint32_t>(parts_.size())});
  }
}

std::uint64_t MotionHash::now() {
  const Store& store = world_.store();
  if (structure_ != store.structure_version()) find(store);
  const double* const live = store.live().data();
  const std::size_t width = Part::table().live_width();
  bodies_.clear();
  std::uint64_t hash = world_.tick();
  std::size_t part = 0;
  for (const Place& place : places_) {
    NumberHash numbers(0);
    numbers.add({live + place.body, Body::table().live_width()});
    for (; part < place.parts_end; part++) numbers.add({live + parts_[part], width});
    bodies_.push_back(numbers.value());
    hash ^= bodies_.back();
    hash = splitmix64(hash);
  }
  return hash;
}

}  // namespace limber
