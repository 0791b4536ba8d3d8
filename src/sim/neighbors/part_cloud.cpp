// PartCloud: indices of the parts, and their values in the store.
#include "sim/neighbors/part_cloud.h"

#include <algorithm>
#include <utility>

#include "sim/behavior/behavior_list.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {
namespace {

// Offsets of a part's motion in its transient values.
struct PartOffsets {
  std::uint32_t position = Part::table().at("position").offset;
  std::uint32_t rotation = Part::table().at("rotation").offset;
  std::uint32_t velocity = Part::table().at("linear_velocity").offset;
  std::uint32_t angular_velocity = Part::table().at("angular_velocity").offset;
};
const PartOffsets& part_offsets() {
  static const PartOffsets found;
  return found;
}

}  // namespace

PartCloud::PartCloud(World& world, std::vector<Part*> parts) : world_(world), parts_(std::move(parts)) {
  part_data_.reserve(parts_.size());
  for (const Part* part : parts_) {
    ids_.push_back(part->id());
    part_data_.push_back(data_of(*part));
  }
  index_parts();
}

void PartCloud::index_parts() {
  centers_.resize(parts_.size());
  std::fill(index_of_slot_.begin(), index_of_slot_.end(), -1);
  for (std::size_t i = 0; i < ids_.size(); i++) {
    const auto slot = static_cast<std::size_t>(ids_[i].slot);
    if (slot >= index_of_slot_.size()) index_of_slot_.resize(slot + 1, -1);
    index_of_slot_[slot] = static_cast<std::int32_t>(i);
  }
  std::fill(body_ordinals_.begin(), body_ordinals_.end(), -1);
  body_count_ = 0;
  for (const PartData& data : part_data_) {
    const auto slot = static_cast<std::size_t>(data.body);
    if (slot >= body_ordinals_.size()) body_ordinals_.resize(slot + 1, -1);
    if (body_ordinals_[slot] < 0) body_ordinals_[slot] = body_count_++;
  }
}

std::uint32_t PartCloud::index_of(const Part& part) const {
  const std::uint32_t slot = part.id().slot;
  return slot < index_of_slot_.size() ? static_cast<std::uint32_t>(index_of_slot_[slot]) : kNoIndex;
}

bool PartCloud::consists_of(std::span<Part* const> parts) const {
  return std::equal(parts.begin(), parts.end(), ids_.begin(), ids_.end(),
                    [](const Part* part, NodeId id) { return part->id() == id; });
}

PartData PartCloud::data_of(const Part& part) const {
  static const std::uint32_t enabled = Body::table().at("enabled").offset;
  const NodeSlot* const slots = world_.store().view()->slots;
  const std::uint32_t body = part.body().id().slot;
  const Vec3 center = part.geometry()->frame.position;
  return {slots[part.id().slot].transient, slots[body].transient + enabled, static_cast<std::int32_t>(body),
          center == Vec3(0), center};
}

Vec3 PartCloud::center_of(const PartData& data) const {
  const double* const transient = world_.store().transient_values().data() + data.transient_offset;
  const Vec3 origin = vec3_at(transient + part_offsets().position);
  if (data.centered) return origin;
  const double* const q = transient + part_offsets().rotation;
  return origin + quat_xyzw(q[0], q[1], q[2], q[3]) * data.center;
}

bool PartCloud::gather() {
  if (const std::uint64_t step = world_.behaviors().step_count(); std::exchange(gathered_step_, step) == step)
    return false;
  const double* const transient = world_.store().transient_values().data();
  points_.clear();
  point_parts_.clear();
  constexpr std::size_t kAhead = 12;  // prefetch: these are no longer in the cache after a tick of physics
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (i + kAhead < parts_.size()) {
      __builtin_prefetch(transient + part_data_[i + kAhead].enabled_offset);
      __builtin_prefetch(transient + part_data_[i + kAhead].transient_offset);
      __builtin_prefetch(transient + part_data_[i + kAhead].transient_offset + part_offsets().angular_velocity + 2);
    }
    if (transient[part_data_[i].enabled_offset] == 0) continue;
    const Vec3 center = center_of(part_data_[i]);
    centers_[i] = center;
    points_.add(static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                part_data_[i].body);
    point_parts_.push_back(static_cast<std::uint32_t>(i));
  }
  points_.one_per_body = static_cast<std::size_t>(body_count_) == parts_.size();
  return true;
}

void PartCloud::remove_body(const Body& body) {
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (&parts_[i]->body() == &body) continue;
    parts_[remaining] = parts_[i];
    ids_[remaining] = ids_[i];
    part_data_[remaining++] = part_data_[i];
  }
  parts_.resize(remaining);
  ids_.resize(remaining);
  part_data_.resize(remaining);
  index_parts();
  gathered_step_ = 0;
}

bool PartCloud::enabled(const PartData& data) const {
  return world_.store().transient_values()[data.enabled_offset] != 0;
}

Vec3 PartCloud::velocity_of(const PartData& data) const {
  return vec3_at(world_.store().transient_values().data() + data.transient_offset + part_offsets().velocity);
}

Vec3 PartCloud::angular_velocity_of(const PartData& data) const {
  return vec3_at(world_.store().transient_values().data() + data.transient_offset + part_offsets().angular_velocity);
}

}  // namespace limber::sim
