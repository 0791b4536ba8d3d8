// What a world remembers: Bullet's memory and the store's numbers as they lie, and of each thing its own fields.
#include "sim/world_key.h"

#include "base/check.h"
#include "sim/behavior_group.h"
#include "sim/behavior_list.h"
#include "sim/joint.h"
#include "sim/motor.h"
#include "sim/part.h"
#include "sim/world.h"

namespace limber {

void WorldKey::take(World& world, PageStore& pages, const WorldKey* before, KeyBytes& scratch) {
  const auto image_of = [&](PageStore::Image& image, std::span<const std::byte> memory, const PageStore::Image* known) {
    image.clear();
    pages.append(image, memory, known);
  };
  const Store& store = world.store();
  world.bullet_memory().arena().copy(pages, before == nullptr ? nullptr : &before->bullet_, bullet_);
  image_of(kept_, std::as_bytes(store.kept()), before == nullptr ? nullptr : &before->kept_);
  image_of(live_, std::as_bytes(store.live()), before == nullptr ? nullptr : &before->live_);
  scratch.begin_taking();
  pass(scratch, world);
  own_size_ = scratch.bytes().size();
  image_of(own_, scratch.bytes(), before == nullptr ? nullptr : &before->own_);
}

void WorldKey::bring_back(World& world, const PageStore& pages, KeyBytes& scratch) const {
  Store& store = world.store();
  world.bullet_memory().arena().bring_back(pages, bullet_);
  pages.copy_back(kept_, 0, std::as_writable_bytes(std::span(store.kept_)));
  pages.copy_back(live_, 0, std::as_writable_bytes(std::span(store.live_)));
  store.kept_version_++;
  scratch.bytes().resize(own_size_);
  pages.copy_back(own_, 0, scratch.bytes());
  scratch.begin_bringing();
  pass(scratch, world);
  world.awake_version_ = 0;
}

void WorldKey::release(PageStore& pages) {
  for (PageStore::Image* image : {&bullet_, &kept_, &live_, &own_}) pages.release(*image);
}

void WorldKey::pass(KeyBytes& key, World& world) {
  key.pass_all(world.tick_, world.health_events_, world.reset_asked_, world.healed_, world.panic_.on_,
               world.panic_.settled_, world.panic_.began_, world.panic_asked_, world.panic_end_asked_,
               world.gears_changed_, world.timestep_since_, world.time_then_, world.tick_then_);
  pass(key, world.store());
  key.pass_all(world.contacts_.reporting_, world.contacts_.pairs_, world.contacts_.begun_, world.camera_moves_.state_);
  pass_loads(key, world);
  for (const auto& body : world.bodies_) pass(key, *body);
  for (const auto& gear : world.gears_) key.pass_all(gear->in_world_, gear->redundant_);
  pass(key, *world.behaviors_);
}

// rows that wait for their effects, in the order in which they will have them
void WorldKey::pass(KeyBytes& key, Store& store) {
  if (key.bringing()) {
    for (const NodeId id : store.marked_) store.nodes_[id.slot].marks = 0;
  }
  key.pass(store.marked_);
  for (const NodeId id : store.marked_) key.pass(store.nodes_[id.slot].marks);
}

// forces that wait for the next step
void WorldKey::pass_loads(KeyBytes& key, World& world) {
  PartLoads& loads = world.loads_;
  if (key.bringing()) {
    for (const std::uint32_t place : loads.waiting_) {
      loads.clear(place);
      loads.loads_[place].waits = false;
    }
  }
  key.pass(loads.waiting_);
  for (const std::uint32_t place : loads.waiting_) key.pass_all(loads.loads_[place], loads.kicks_[place]);
}

void WorldKey::pass(KeyBytes& key, Body& body) {
  key.pass_all(body.planned_, body.in_world_, body.entered_parts_, body.entered_joints_, body.moved_, body.fresh_);
  key.pass_all(body.pairs_.list, body.pairs_.checked, body.reported_static_velocity_, body.said_clamp_);
  key.pass_all(body.last_good_, body.good_poses_, body.restored_once_, body.broken_);
  for (const auto& part : body.parts_) key.pass_all(part->start_, part->reports_);
  for (const auto& joint : body.joints_) {
    key.pass_all(joint->open_, joint->in_world_, joint->gear_in_world_, joint->start_angles_, joint->torn_ticks_);
  }
  for (const auto& motor : body.motors_)
    key.pass_all(motor->said_contradiction_, motor->said_cap_, motor->warned_outside_, motor->hold_);
}

void WorldKey::pass(KeyBytes& key, Behavior& behavior) {
  key.pass_all(behavior.beats_, behavior.random_, behavior.seeded_with_, behavior.resolved_at_, behavior.fresh_);
  key.pass_all(behavior.fault_.text, behavior.fault_.file, behavior.fault_.line);
  behavior.pass_memory(key);
}

void WorldKey::pass(KeyBytes& key, BehaviorList& behaviors) {
  for (const BehaviorList::Entry& entry : behaviors.entries_) {
    if (entry.single != nullptr) pass(key, *entry.single);
    if (entry.group == nullptr) continue;
    for (const auto& member : entry.group->members_) pass(key, *member);
    // what it has laid out of its members is worked out anew
    if (key.bringing()) entry.group->laid_out_ = false;
  }
}

}  // namespace limber
