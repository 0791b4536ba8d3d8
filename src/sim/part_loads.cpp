// PartLoads: places, and handing over.
#include "sim/part_loads.h"

#include "base/prefetch.h"
#include "sim/part.h"

namespace limber {

std::uint32_t PartLoads::add(Part& part) {
  if (spare_.empty()) {
    spare_.push_back(static_cast<std::uint32_t>(loads_.size()));
    loads_.emplace_back();
    kicks_.emplace_back();
    waiting_.reserve(loads_.capacity());
  }
  const std::uint32_t place = spare_.back();
  spare_.pop_back();
  loads_[place].part = &part;
  const std::uint32_t slot = part.id().slot;
  if (slot >= places_.size()) places_.resize(slot + 1, kNone);
  places_[slot] = place;
  return place;
}

void PartLoads::remove(std::uint32_t place) {
  clear(place);
  places_[loads_[place].part->id().slot] = kNone;
  loads_[place].part = nullptr;
  spare_.push_back(place);
}

void PartLoads::clear(std::uint32_t place) {
  loads_[place].force = loads_[place].torque = Vec3(0);
  kicks_[place] = {};
}

void PartLoads::drop() {
  for (const std::uint32_t place : waiting_) {
    loads_[place].waits = false;
    clear(place);
  }
  waiting_.clear();
}

// Many parts are far off by now. What one finds leads to the next: the load, its part, what Bullet has of that.
void PartLoads::fetch_ahead(std::size_t at) const {
  constexpr std::size_t kAhead = 5;
  const auto part = [&](std::size_t far) -> const Part* {
    return at + far < waiting_.size() ? loads_[waiting_[at + far]].part : nullptr;
  };
  if (at + 3 * kAhead < waiting_.size()) fetch(waiting_[at + 3 * kAhead]);
  if (const Part* const far = part(2 * kAhead); far != nullptr) prefetch(far, sizeof(Part));
  if (const Part* const near = part(kAhead); near != nullptr) Part::fetch(near);
}

void PartLoads::push() {
  for (std::size_t i = 0; i < waiting_.size(); i++) {
    fetch_ahead(i);
    const std::uint32_t place = waiting_[i];
    Load& load = loads_[place];
    load.waits = false;
    if (load.part != nullptr) load.part->push(load, kicks_[place]);
    clear(place);
  }
  waiting_.clear();
}

}  // namespace limber
