// MotionHash: hashes body by body, with indices that are cached until the structure changes.
#include "sim/state/motion_hash.h"

#include <array>

#include "base/hash.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

// Offsets of a part's pose and velocities in its transient values.
std::array<std::uint32_t, 13> motion_offsets() {
  std::array<std::uint32_t, 13> offsets{};
  std::size_t at = 0;
  for (const char* name : {"position", "rotation", "linear_velocity", "angular_velocity"}) {
    const Property& property = Part::table().at(name);
    for (std::uint32_t i = 0; i < property.width; i++) offsets.at(at++) = property.offset + i;
  }
  return offsets;
}

}  // namespace

void MotionHash::update_indices(const Store& store) {
  structure_version_ = store.structure_version();
  body_indices_.clear();
  part_indices_.clear();
  const auto index_of = [&](NodeId id) {
    return static_cast<std::uint32_t>(store.transient_block(id) - store.transient_values().data());
  };
  for (const auto& body : world_.bodies()) {
    for (const auto& part : body->parts()) part_indices_.push_back(index_of(part->id()));
    body_indices_.push_back({index_of(body->id()), static_cast<std::uint32_t>(part_indices_.size())});
  }
}

std::uint64_t MotionHash::compute() {
  const Store& store = world_.store();
  if (structure_version_ != store.structure_version()) update_indices(store);
  const double* const transient = store.transient_values().data();
  static const std::array<std::uint32_t, 13> kOffsets = motion_offsets();
  static const std::uint32_t kEnabled = Body::table().at("enabled").offset;
  std::array<double, 13> motion{};
  body_hashes_.clear();
  std::uint64_t hash = world_.tick();
  std::size_t part = 0;
  for (const BodyIndices& body : body_indices_) {
    NumberHash numbers(0);
    numbers.add({transient + body.body_index + kEnabled, 1});
    for (; part < body.parts_end; part++) {
      for (std::size_t i = 0; i < motion.size(); i++) motion[i] = transient[part_indices_[part] + kOffsets[i]];
      numbers.add(motion);
    }
    body_hashes_.push_back(numbers.value());
    hash ^= body_hashes_.back();
    hash = splitmix64(hash);
  }
  return hash;
}

}  // namespace limber::sim
