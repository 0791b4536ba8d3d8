// WorldCheckpoint: serializes Bullet's memory and the store's values as raw pages, and the fields of each object.
#include "sim/state/world_checkpoint.h"

#include "base/check.h"
#include "sim/behavior/behavior_group.h"
#include "sim/behavior/behavior_list.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber {

void WorldCheckpoint::capture(World& world, PageStore& pages, const WorldCheckpoint* previous, Archive& scratch) {
  const auto capture_pages = [&](PageStore::PageList& pages_of, std::span<const std::byte> memory,
                                 const PageStore::PageList* shared) {
    pages_of.clear();
    pages.append(pages_of, memory, shared);
  };
  const Store& store = world.store();
  world.bullet_memory().arena().capture(pages, previous == nullptr ? nullptr : &previous->bullet_, bullet_);
  capture_pages(persistent_, std::as_bytes(store.persistent_values()),
                previous == nullptr ? nullptr : &previous->persistent_);
  capture_pages(transient_, std::as_bytes(store.transient_values()),
                previous == nullptr ? nullptr : &previous->transient_);
  scratch.begin_saving();
  serialize(scratch, world);
  objects_size_ = scratch.bytes().size();
  capture_pages(objects_, scratch.bytes(), previous == nullptr ? nullptr : &previous->objects_);
}

void WorldCheckpoint::restore(World& world, const PageStore& pages, Archive& scratch) const {
  Store& store = world.store();
  world.bullet_memory().arena().restore(pages, bullet_);
  pages.restore(persistent_, 0, std::as_writable_bytes(std::span(store.persistent_)));
  pages.restore(transient_, 0, std::as_writable_bytes(std::span(store.transient_)));
  store.persistent_version_++;
  scratch.bytes().resize(objects_size_);
  pages.restore(objects_, 0, scratch.bytes());
  scratch.begin_loading();
  serialize(scratch, world);
  world.awake_version_ = 0;
}

void WorldCheckpoint::release(PageStore& pages) {
  for (PageStore::PageList* list : {&bullet_, &persistent_, &transient_, &objects_}) pages.release(*list);
}

void WorldCheckpoint::serialize(Archive& archive, World& world) {
  archive.serialize_all(world.tick_, world.health_events_, world.reset_requested_, world.body_restored_,
                        world.panic_.on_, world.panic_.first_second_over_, world.panic_.start_tick_,
                        world.panic_requested_, world.panic_end_requested_, world.gears_dirty_, world.last_timestep_,
                        world.time_at_timestep_change_, world.tick_at_timestep_change_);
  serialize(archive, world.store());
  archive.serialize_all(world.contacts_.reporting_, world.contacts_.pairs_, world.contacts_.events_,
                        world.camera_moves_.state_);
  serialize_forces(archive, world);
  for (const auto& body : world.bodies_) serialize(archive, *body);
  for (const auto& gear : world.gears_) archive.serialize_all(gear->in_world_, gear->redundant_);
  serialize(archive, *world.behaviors_);
}

// Properties with pending on-change callbacks, in the order in which these will be called.
void WorldCheckpoint::serialize(Archive& archive, Store& store) {
  if (archive.loading()) {
    for (const NodeId id : store.dirty_nodes_) store.nodes_[id.slot].dirty = 0;
  }
  archive.serialize(store.dirty_nodes_);
  for (const NodeId id : store.dirty_nodes_) archive.serialize(store.nodes_[id.slot].dirty);
}

// Forces that are pending for the next step.
void WorldCheckpoint::serialize_forces(Archive& archive, World& world) {
  ForceAccumulators& forces = world.force_accumulators_;
  if (archive.loading()) {
    for (const std::uint32_t index : forces.pending_) {
      forces.clear(index);
      forces.wrenches_[index].pending = false;
    }
  }
  archive.serialize(forces.pending_);
  for (const std::uint32_t index : forces.pending_)
    archive.serialize_all(forces.wrenches_[index], forces.impulses_[index]);
}

void WorldCheckpoint::serialize(Archive& archive, Body& body) {
  archive.serialize_all(body.initial_pose_, body.in_world_, body.added_parts_, body.added_joints_, body.joints_dirty_,
                        body.is_new_);
  archive.serialize_all(body.pairs_.list, body.pairs_.checked_count, body.warned_static_velocity_,
                        body.warned_clamped_);
  archive.serialize_all(body.good_poses_, body.good_pose_count_, body.restored_once_, body.restored_this_tick_);
  for (const auto& part : body.parts_) archive.serialize_all(part->start_, part->report_contacts_);
  for (const auto& joint : body.joints_) {
    archive.serialize_all(joint->open_axes_, joint->in_world_, joint->gear_in_world_, joint->start_angles_,
                          joint->separated_ticks_);
  }
  for (const auto& motor : body.motors_)
    archive.serialize_all(motor->warned_contradiction_, motor->warned_capped_, motor->warned_target_outside_,
                          motor->held_position_);
}

void WorldCheckpoint::serialize(Archive& archive, Behavior& behavior) {
  archive.serialize_all(behavior.timers_, behavior.random_, behavior.seeded_with_, behavior.resolved_structure_,
                        behavior.needs_start_);
  archive.serialize_all(behavior.fault_.text, behavior.fault_.file, behavior.fault_.line);
  behavior.serialize(archive);
}

void WorldCheckpoint::serialize(Archive& archive, BehaviorList& behaviors) {
  for (const BehaviorList::Entry& entry : behaviors.entries_) {
    if (entry.single != nullptr) serialize(archive, *entry.single);
    if (entry.group == nullptr) continue;
    for (const auto& member : entry.group->members_) serialize(archive, *member);
    // the cached layout of its members is computed again
    if (archive.loading()) entry.group->layout_valid_ = false;
  }
}

}  // namespace limber
