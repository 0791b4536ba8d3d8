// Behavior: targets, intervals, random generator and errors, common to all types.
#include "sim/behavior/behavior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/memory/archive.h"
#include "base/text.h"
#include "properties/values_hash.h"
#include "sim/behavior/behavior_group.h"
#include "sim/behavior/behavior_list.h"
#include "sim/world/world.h"

namespace limber {

namespace {

using namespace properties;

// Returns the names of a body's parts, joints or motors.
template <class T>
std::vector<std::string_view> names_of(std::span<const std::unique_ptr<T>> objects) {
  std::vector<std::string_view> names;
  for (const auto& object : objects) names.push_back(object->name());
  return names;
}

bool can_move(const Part& part) { return !part.is_static(); }
bool can_move(const Joint&) { return true; }

// Returns the selected objects in stream order; "all" selects only those that can move.
template <class T>
std::vector<T*> selected(const Selection& selection, std::span<const std::unique_ptr<T>> objects) {
  std::vector<T*> list;
  for (const auto& object : objects) {
    if (selection.selects(object->name(), can_move(*object))) list.push_back(object.get());
  }
  return list;
}

// Returns the selected parts in the order of the selection's words, by which the scene defines the pairs.
std::vector<Part*> selected_in_order(const Selection& selection, std::span<const std::unique_ptr<Part>> parts) {
  if (selection.is_default()) return selected(selection, parts);
  std::vector<Part*> list;
  for (const std::string& word : selection.words()) {
    const std::vector<Part*> matches = selected(Selection({word}), parts);
    list.insert(list.end(), matches.begin(), matches.end());
  }
  return list;
}

template <class T>
Result<void> check_names(const Body& body, std::string_view kind, const Selection& selection,
                         std::span<const std::unique_ptr<T>> objects) {
  if (!selection.has_names()) return {};
  const std::vector<std::string_view> names = names_of(objects);
  const std::string_view missing = selection.first_missing(names);
  if (missing.empty()) return {};
  return Error{
      fmt::format("body '{}' has no {} '{}'{}", body.name(), kind, printable(missing), name_hint(missing, names))};
}

}  // namespace

std::vector<Property> Behavior::common_properties() {
  Property active = boolean("active", true, "Whether it acts; setting it also clears an error.");
  active.on_write = &Behavior::on_active_written;
  return {
      std::move(active),
      computed<&Behavior::read_time>(
          readout(properties::number("time", "µs", 0, 0, kUnbounded, "Time that it took in the last tick."))),
      invokes<&Behavior::act_remove>(action("remove", 0, 0, "Removes the behavior.")),
      validated_by<&Behavior::validate_place>(properties::state(computed<&Behavior::read_place, &Behavior::write_place>(
          integer("place", 1, 1, 1e6, "Position in the step order of its body's behaviors, from 1."))))};
}

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

const std::string& Behavior::name() const { return store().name(id_); }
Store& Behavior::store() const { return world_->store(); }

const double* Behavior::values(std::uint32_t parameter) const {
  return store().values(id_, type_->table->property(kCommonBehaviorProperties + parameter));
}

bool Behavior::active() const { return store().values(id_, type_->table->property(0))[0] != 0; }
bool Behavior::runs() const { return !removed() && active() && state_.fault.text.empty() && body_->enabled(); }
double Behavior::step_microseconds() const {
  return 1e6 * (group_ == nullptr ? step_seconds_ : group_->seconds_per_member());
}
void Behavior::read_time(double* out) const { out[0] = step_microseconds(); }

void Behavior::read_place(double* out) const { out[0] = static_cast<double>(world().behaviors().place(*this)); }

void Behavior::write_place(const double* in) { world().behaviors().move_to(*this, static_cast<std::size_t>(in[0])); }

Result<void> Behavior::validate_place(const double*) const {
  if (group_ != nullptr)
    return Error{fmt::format("a group's member has no place of its own; set /physics/group/{}/place", name())};
  return world().behaviors().check_can_move();
}

void Behavior::on_active_written(void* object, const Property&) {
  auto& behavior = *static_cast<Behavior*>(object);
  behavior.save_for_rollback();
  behavior.state_.fault = {};
}

void Behavior::request_preparation() {
  if (group_ != nullptr) group_->request_preparation();
}

void Behavior::save_for_rollback() {
  if (world().transaction().first_in_call(saved_in_call_)) world().behaviors().transaction().save(*this);
}

void Behavior::restore(const State& state) {
  state_ = state;
  request_preparation();
}

Result<void> Behavior::act_remove(std::span<const double>) {
  world().behaviors().remove(*this);
  return {};
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
  const double interval = 1e-3 * store().values(id_, property)[0];
  // a sum of time steps deviates from a multiple of the interval by a few bits
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
  world_ = &body.world();
  body_ = &body;
  type_ = std::move(type);
  setup_ = std::move(setup);
  group_ = group;
  state_.timers.reserve(4);
  return resolve();
}

void Behavior::add_node(const std::string& name) {
  id_ = store().add(*type_->table, body_->behavior_group(), name, this);
  body_->insert_behavior(body_->behaviors().size(), *this);
}

std::unique_ptr<Behavior> Behavior::make_replacement(const std::shared_ptr<const BehaviorType>& type) {
  std::unique_ptr<Behavior> behavior = type->make();
  behavior->world_ = world_;
  behavior->body_ = body_;
  behavior->group_ = group_;
  behavior->type_ = type;
  behavior->setup_ = setup_;
  behavior->targets_ = targets_;
  State& state = behavior->state_;
  state.random = state_.random;
  state.seeded_with = state_.seeded_with;
  state.needs_start = state_.needs_start;
  state.timers.reserve(4);
  for (const IntervalTimer& timer : state_.timers) {
    const Property* const property = type->table->find(timer.property->name);
    if (property != nullptr) state.timers.push_back({property, timer.anchor, timer.interval, timer.count});
  }
  behavior->id_ = store().change_table(id_, *type->table, behavior.get());
  body_->replace_behavior(*this, *behavior);
  behavior->adopt_state(*this);
  return behavior;
}

// Resolves the selections to targets. A missing name is an error; all other targets are resolved nevertheless.
Result<void> Behavior::resolve() {
  const BehaviorSetup& s = *setup_;
  const Body& body = *body_;
  const bool pairs = type_->targets == BehaviorTargets::pairs;
  Targets targets;
  targets.parts = pairs ? selected_in_order(s.parts, body.parts()) : selected(s.parts, body.parts());
  targets.joints = selected(s.joints, body.joints());
  // if a type acts on motors, a selection of joints adds the motors of these joints to the selected motors, or
  // replaces "all"
  const bool by_joints = type_->targets == BehaviorTargets::motors && !s.joints.is_default();
  for (const auto& motor : body.motors()) {
    const bool explicitly_selected = !(by_joints && s.motors.is_default()) && s.motors.selects(motor->name());
    if (explicitly_selected || (by_joints && s.joints.selects(motor->joint().name())))
      targets.motors.push_back(motor.get());
  }
  if (targets != targets_) {
    if (!id_.null()) world().behaviors().transaction().save_targets(*this);  // else it is under construction
    targets_ = std::move(targets);
    state_.needs_start = true;
  }
  state_.resolved_structure = body.structure_version();
  if (group_ != nullptr) return {};  // bodies selected by a pattern need not have all names: the group checks them
  if (Result<void> exist = check_names(body, "part", s.parts, body.parts()); !exist) return exist;
  if (Result<void> exist = check_names(body, "joint", s.joints, body.joints()); !exist) return exist;
  if (Result<void> exist = check_names(body, "motor", s.motors, body.motors()); !exist) return exist;
  for (const Joint* joint : targets_.joints) {
    const bool named =
        std::find(s.joints.words().begin(), s.joints.words().end(), joint->name()) != s.joints.words().end();
    if (!by_joints || !named || joint->motor() != nullptr) continue;
    return Error{fmt::format("joint '{}/{}' has no motor; add one with add_motor", body.name(), joint->name())};
  }
  return {};
}

void Behavior::update_targets() {
  if (state_.resolved_structure == body_->structure_version()) return;
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
    state_.random = Random(seed, store().path(id_));
  }
  if (!std::exchange(state_.needs_start, false)) return;
  state_.timers.clear();
  start();
}

std::uint64_t Behavior::state_hash(std::uint64_t hash) const {
  NumberHash numbers(hash_bytes(type_->name, hash_bytes(name(), hash)));
  numbers.add_word(persistent_hash(store(), id_));
  if (state_.random.used()) numbers.add(state_.random.state());
  for (const IntervalTimer& timer : state_.timers) numbers.add(timer.anchor, timer.interval, timer.count);
  return numbers.value();
}

}  // namespace limber
