// ForceAccumulators: allocation, and applying the accumulated forces.
#include "sim/world/force_accumulators.h"

#include "base/memory/archive.h"
#include "base/memory/prefetch.h"
#include "sim/bullet/bullet.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {

// Applies pending forces and impulses to Bullet.
void apply_to_bullet(Part& part, const ForceAccumulators::Wrench& wrench, const ForceAccumulators::Impulse& impulse) {
  btRigidBody& rigid = part.rigid();
  if (part.is_static() || !rigid.isInWorld()) return;
  const Vec3 none(0);
  if (wrench.force == none && wrench.torque == none && impulse.linear == none && impulse.angular == none) return;
  part.wake();
  // clamped to more than any part withstands, but finite: NaN and infinities would spread to all parts that it
  // touches
  const Vec3 limit(1e15);
  const auto clamped = [&](const Vec3& v) { return bullet::to_bt(glm::clamp(v, -limit, limit)); };
  rigid.applyCentralForce(clamped(wrench.force));
  rigid.applyTorque(clamped(wrench.torque));
  rigid.applyCentralImpulse(clamped(impulse.linear));
  rigid.applyTorqueImpulse(clamped(impulse.angular));
}

}  // namespace

std::uint32_t ForceAccumulators::add(Part& part) {
  if (free_.empty()) {
    free_.push_back(static_cast<std::uint32_t>(wrenches_.size()));
    wrenches_.emplace_back();
    impulses_.emplace_back();
    pending_.reserve(wrenches_.capacity());
  }
  const std::uint32_t index = free_.back();
  free_.pop_back();
  wrenches_[index].part = &part;
  const std::uint32_t slot = part.id().slot;
  if (slot >= index_of_slot_.size()) index_of_slot_.resize(slot + 1, kNone);
  index_of_slot_[slot] = index;
  return index;
}

void ForceAccumulators::remove(std::uint32_t index) {
  clear(index);
  index_of_slot_[wrenches_[index].part->id().slot] = kNone;
  wrenches_[index].part = nullptr;
  free_.push_back(index);
}

void ForceAccumulators::clear(std::uint32_t index) {
  wrenches_[index].force = wrenches_[index].torque = Vec3(0);
  impulses_[index] = {};
}

void ForceAccumulators::discard() {
  for (const std::uint32_t index : pending_) {
    wrenches_[index].pending = false;
    clear(index);
  }
  pending_.clear();
}

// Prefetches in stages, since each stage finds the address of the next: accumulator, part, Bullet's rigid body. In
// large scenes, most of them are no longer in the cache.
void ForceAccumulators::prefetch_ahead(std::size_t index) const {
  constexpr std::size_t kAhead = 5;
  const auto part = [&](std::size_t far) -> const Part* {
    return index + far < pending_.size() ? wrenches_[pending_[index + far]].part : nullptr;
  };
  if (index + 3 * kAhead < pending_.size()) prefetch_wrench(pending_[index + 3 * kAhead]);
  if (const Part* const far = part(2 * kAhead); far != nullptr) prefetch(far, sizeof(Part));
  if (const Part* const near = part(kAhead); near != nullptr) prefetch(&near->rigid(), sizeof(btRigidBody));
}

void ForceAccumulators::apply() {
  for (std::size_t i = 0; i < pending_.size(); i++) {
    prefetch_ahead(i);
    const std::uint32_t index = pending_[i];
    Wrench& wrench = wrenches_[index];
    wrench.pending = false;
    if (wrench.part != nullptr) apply_to_bullet(*wrench.part, wrench, impulses_[index]);
    clear(index);
  }
  pending_.clear();
}

void ForceAccumulators::serialize(Archive& archive) {
  if (archive.loading()) discard();
  archive.serialize(pending_);
  for (const std::uint32_t index : pending_) archive.serialize_all(wrenches_[index], impulses_[index]);
}

}  // namespace limber::sim
