// Bodies one after the other, found anew when anything came or went.
#include "sim/motion_hash.h"

#include <array>

#include "base/hash.h"
#include "sim/world.h"

namespace limber {

namespace {

// places of the numbers that are motion, in a part's live block
std::array<std::uint32_t, 13> motion_numbers() {
  std::array<std::uint32_t, 13> places{};
  std::size_t at = 0;
  for (const char* name : {"position", "rotation", "linear_velocity", "angular_velocity"}) {
    const Row& row = Part::table().at(name);
    for (std::uint32_t i = 0; i < row.width; i++) places.at(at++) = row.offset + i;
  }
  return places;
}

}  // namespace

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
  static const std::array<std::uint32_t, 13> kNumbers = motion_numbers();
  static const std::uint32_t kEnabled = Body::table().at("enabled").offset;
  std::array<double, 13> motion{};
  bodies_.clear();
  std::uint64_t hash = world_.tick();
  std::size_t part = 0;
  for (const Place& place : places_) {
    NumberHash numbers(0);
    numbers.add({live + place.body + kEnabled, 1});
    for (; part < place.parts_end; part++) {
      for (std::size_t i = 0; i < motion.size(); i++) motion[i] = live[parts_[part] + kNumbers[i]];
      numbers.add(motion);
    }
    bodies_.push_back(numbers.value());
    hash ^= bodies_.back();
    hash = splitmix64(hash);
  }
  return hash;
}

}  // namespace limber
