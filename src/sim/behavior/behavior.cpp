// Behavior: intervals, random generator and errors, common to all types.
#include "sim/behavior/behavior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/hash.h"
#include "base/memory/archive.h"
#include "properties/values_hash.h"
#include "sim/behavior/behavior_group.h"
#include "sim/behavior/behavior_list.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

Behavior::Behavior() = default;
Behavior::~Behavior() = default;

void Behavior::step_group(std::span<Behavior* const> members, double dt) {
  for (Behavior* member : members) {
    if (member->runs()) member->step(dt);
  }
}

void Behavior::adopt_state(Behavior&) {}

void Behavior::serialize(Archive&) {}

void Behavior::serialize_all(Archive& archive) {
  auto& [timers, random, seeded_with, fault, resolved_structure, needs_start] = state_;
  auto& [text, file, line] = fault;
  archive.serialize_all(timers, random, seeded_with, text, file, line, resolved_structure, needs_start);
  serialize(archive);
}

const double* Behavior::values(std::uint32_t parameter) const {
  return store().values(id(), type().table->property(kCommonBehaviorProperties + parameter));
}

bool Behavior::active() const { return store().values(id(), type().table->property(0))[0] != 0; }
bool Behavior::runs() const { return !removed() && active() && state_.fault.text.empty() && body().enabled(); }
double Behavior::step_microseconds() const {
  return 1e6 * (group() == nullptr ? step_seconds_ : group()->seconds_per_member());
}

void Behavior::clear_fault() {
  save_for_rollback();
  state_.fault = {};
}

void Behavior::request_preparation() {
  if (group() != nullptr) group()->request_preparation();
}

void Behavior::save_for_rollback() {
  if (world().transaction().first_in_call(saved_in_call_)) world().behaviors().transaction().save(*this);
}

void Behavior::restore(const State& state) {
  state_ = state;
  request_preparation();
}

void Behavior::fail(BehaviorFault fault) {
  if (removed()) return;
  save_for_rollback();
  state_.fault = std::move(fault);
  request_preparation();
  world().behaviors().report_fault(*this);
}

Vec3 Behavior::random_between(const Vec3& a, const Vec3& b) {
  const double x = random_between(a.x, b.x);
  const double y = random_between(a.y, b.y);
  return {x, y, random_between(a.z, b.z)};
}

bool Behavior::interval_elapsed(const Property& property) {
  save_for_rollback();
  const double now = world().time();
  const double tick = world().timestep();
  const double interval = 1e-3 * store().values(id(), property)[0];
  // the time, a multiple of the time step, deviates from a multiple of the interval by a few bits
  const double tolerance = 1e-4 * tick;
  const auto existing = std::find_if(state_.timers.begin(), state_.timers.end(),
                                     [&](const IntervalTimer& b) { return b.property == &property; });
  if (existing == state_.timers.end()) {
    state_.timers.push_back({&property, now, interval, 0});
    return true;
  }
  IntervalTimer& timer = *existing;
  if (interval <= tick) {
    timer = {&property, now, interval, 0};
    return true;
  }
  // a changed interval is counted from the last time that the old one elapsed
  if (interval != timer.interval) timer = {&property, timer.anchor + timer.count * timer.interval, interval, 0};
  const double count = std::floor((now + tolerance - timer.anchor) / interval);
  return count > std::exchange(timer.count, std::max(count, timer.count));
}

Result<void> Behavior::attach(Body& body, std::shared_ptr<const BehaviorType> type,
                              std::shared_ptr<const BehaviorSetup> setup, BehaviorGroup* group) {
  attach_to(body, std::move(type), std::move(setup), group);
  state_.timers.reserve(4);
  return resolve();
}

void Behavior::add_node(const std::string& name) {
  set_id(store().add(*type().table, body().behaviors().group(), name, this));
  body().behaviors().insert(body().behaviors().list().size(), *this);
}

std::unique_ptr<Behavior> Behavior::make_replacement(const std::shared_ptr<const BehaviorType>& type) {
  std::unique_ptr<Behavior> behavior = type->make();
  behavior->attach_to(body(), type, shared_setup(), group());
  behavior->set_targets(targets());
  State& state = behavior->state_;
  state.random = state_.random;
  state.seeded_with = state_.seeded_with;
  state.needs_start = state_.needs_start;
  state.timers.reserve(4);
  for (const IntervalTimer& timer : state_.timers) {
    const Property* const property = type->table->find(timer.property->name);
    if (property != nullptr) state.timers.push_back({property, timer.anchor, timer.interval, timer.count});
  }
  behavior->set_id(store().change_table(id(), *type->table, behavior.get()));
  body().behaviors().replace(*this, *behavior);
  behavior->adopt_state(*this);
  return behavior;
}

// A missing name is an error; all other targets are resolved nevertheless.
Result<void> Behavior::resolve() {
  if (Targets current = selected_targets(); current != targets()) {
    if (!id().null()) world().behaviors().transaction().save_targets(*this);  // else it is under construction
    set_targets(std::move(current));
    state_.needs_start = true;
  }
  state_.resolved_structure = body().structure_version();
  return check_selected_names();
}

void Behavior::update_targets() {
  if (state_.resolved_structure == body().structure_version()) return;
  if (const Result<void> resolved = resolve(); !resolved) fail({resolved.error(), "", 0});
}

void Behavior::restart() {
  save_for_rollback();
  request_preparation();
  state_.needs_start = true;
  state_.seeded_with = kNoSeed;
}

void Behavior::prepare() {
  if (const std::uint64_t seed = world().seed(); seed != state_.seeded_with) {
    state_.seeded_with = seed;
    state_.random = Random(seed, store().path(id()));
  }
  if (!std::exchange(state_.needs_start, false)) return;
  state_.timers.clear();
  start();
}

std::uint64_t Behavior::state_hash(std::uint64_t hash) const {
  NumberHash numbers(hash_bytes(type().name, hash_bytes(name(), hash)));
  numbers.add_word(persistent_hash(store(), id()));
  if (state_.random.used()) numbers.add(state_.random.state());
  for (const IntervalTimer& timer : state_.timers) numbers.add(timer.anchor, timer.interval, timer.count);
  return numbers.value();
}

}  // namespace limber::sim
