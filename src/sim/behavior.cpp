// Behavior: what all of them have: targets, intervals, generator, errors.
#include "sim/behavior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "params/values_hash.h"
#include "sim/behavior_group.h"
#include "sim/behavior_list.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

// the names of a body's parts, joints or motors
template <class T>
std::vector<std::string_view> names_of(std::span<const std::unique_ptr<T>> things) {
  std::vector<std::string_view> names;
  for (const auto& thing : things) names.push_back(thing->name());
  return names;
}

bool moves(const Part& part) { return !part.is_static(); }
bool moves(const Joint&) { return true; }

// those that the selection means, in stream order; "all" takes only what moves
template <class T>
std::vector<T*> chosen(const Selection& selection, std::span<const std::unique_ptr<T>> things) {
  std::vector<T*> list;
  for (const auto& thing : things) {
    if (selection.means(thing->name(), moves(*thing))) list.push_back(thing.get());
  }
  return list;
}

// word by word: the scene says who is paired with whom
std::vector<Part*> chosen_in_order(const Selection& selection, std::span<const std::unique_ptr<Part>> parts) {
  if (selection.left_out()) return chosen(selection, parts);
  std::vector<Part*> list;
  for (const std::string& word : selection.words()) {
    const std::vector<Part*> some = chosen(Selection({word}), parts);
    list.insert(list.end(), some.begin(), some.end());
  }
  return list;
}

template <class T>
Result<void> names_exist(const Body& body, std::string_view kind, const Selection& selection,
                         std::span<const std::unique_ptr<T>> things) {
  if (!selection.has_names()) return {};
  const std::vector<std::string_view> names = names_of(things);
  const std::string_view missing = selection.missing(names);
  if (missing.empty()) return {};
  return Error{
      fmt::format("body '{}' has no {} '{}'{}", body.name(), kind, printable(missing), name_hint(missing, names))};
}

}  // namespace

std::vector<Row> Behavior::common_rows() {
  Row on = boolean("active", true, "Whether it acts; setting it also tries again after an error.");
  on.written = &Behavior::active_written;
  return {std::move(on),
          view<&Behavior::read_time>(
              readout(rows::number("time", "µs", 0, 0, kUnbounded, "What the last tick spent on it."))),
          act<&Behavior::act_remove>(action("remove", 0, 0, "Takes the behaviour away.")),
          refuse<&Behavior::refuse_place>(state(view<&Behavior::read_place, &Behavior::write_place>(
              integer("place", 1, 1, 1e6, "Which one it is, from 1, of those that act on its body in a tick."))))};
}

Behavior::Behavior() = default;
Behavior::~Behavior() = default;

void Behavior::step_group(std::span<Behavior* const> members, double dt) {
  for (Behavior* member : members) {
    if (member->runs()) member->step(dt);
  }
}

void Behavior::take_over(Behavior&) {}

void Behavior::pass_memory(KeyBytes&) {}

const std::string& Behavior::name() const { return store().name(id_); }
Store& Behavior::store() const { return world_->store(); }

const double* Behavior::values(std::uint32_t parameter) const {
  return store().values(id_, type_->table->row(kCommonBehaviorRows + parameter));
}

bool Behavior::active() const { return store().values(id_, type_->table->row(0))[0] != 0; }
bool Behavior::runs() const { return !removed() && active() && fault_.text.empty() && body_->enabled(); }
double Behavior::microseconds() const { return 1e6 * (group_ == nullptr ? seconds_ : group_->seconds_a_member()); }
void Behavior::read_time(double* out) const { out[0] = microseconds(); }

void Behavior::read_place(double* out) const { out[0] = static_cast<double>(world().behaviors().place(*this)); }

void Behavior::write_place(const double* in) { world().behaviors().put_at(*this, static_cast<std::size_t>(in[0])); }

Result<void> Behavior::refuse_place(const double*) const {
  if (group_ != nullptr) return Error{fmt::format("it acts where its group does: set /physics/group/{}/place", name())};
  return world().behaviors().may_move();
}

void Behavior::active_written(void* thing, const Row&) {
  auto& behavior = *static_cast<Behavior*>(thing);
  behavior.world().behaviors().undo().keep(behavior);
  behavior.fault_ = {};
}

void Behavior::call_attention() {
  if (group_ != nullptr) group_->attention_ = true;
}

Result<void> Behavior::act_remove(std::span<const double>) {
  world().behaviors().remove(*this);
  return {};
}

void Behavior::fail(BehaviorFault fault) {
  if (removed()) return;
  world().behaviors().undo().keep(*this);
  fault_ = std::move(fault);
  call_attention();
  world().behaviors().say_fault(*this);
}

Vec3 Behavior::random_between(const Vec3& a, const Vec3& b) {
  const double x = random_between(a.x, b.x);
  const double y = random_between(a.y, b.y);
  return {x, y, random_between(a.z, b.z)};
}

bool Behavior::due(const Row& row) {
  world().behaviors().undo().keep(*this);
  const double now = world().time();
  const double tick = world().timestep();
  const double interval = 1e-3 * store().values(id_, row)[0];
  // a sum of time steps misses a multiple by a few bits
  const double slack = 1e-4 * tick;
  const auto known = std::find_if(beats_.begin(), beats_.end(), [&](const Beat& b) { return b.row == &row; });
  if (known == beats_.end()) {
    beats_.push_back({&row, now, interval, 0});
    return true;
  }
  Beat& beat = *known;
  if (interval <= tick) {
    beat = {&row, now, interval, 0};
    return true;
  }
  // another interval counts from the last beat of the old one
  if (interval != beat.interval) beat = {&row, beat.anchor + beat.count * beat.interval, interval, 0};
  const double count = std::floor((now + slack - beat.anchor) / interval);
  return count > std::exchange(beat.count, std::max(count, beat.count));
}

void Behavior::attach(Body& body, NodeId id, std::shared_ptr<const BehaviorType> type,
                      std::shared_ptr<const BehaviorSetup> setup, BehaviorGroup* group) {
  world_ = &body.world();
  body_ = &body;
  id_ = id;
  type_ = std::move(type);
  setup_ = std::move(setup);
  group_ = group;
  beats_.reserve(4);
}

// a name that is gone is an error; what else is meant is taken
Result<void> Behavior::resolve() {
  const BehaviorSetup& s = *setup_;
  const Body& body = *body_;
  const bool pairs = type_->targets == BehaviorTargets::pairs;
  std::vector<Part*> parts = pairs ? chosen_in_order(s.parts, body.parts()) : chosen(s.parts, body.parts());
  std::vector<Joint*> joints = chosen(s.joints, body.joints());
  std::vector<Motor*> motors;
  // where a type moves motors, joints mean theirs: beside motors that are said, or instead of all
  const bool by_joints = type_->targets == BehaviorTargets::motors && !s.joints.left_out();
  for (const auto& motor : body.motors()) {
    const bool said = !(by_joints && s.motors.left_out()) && s.motors.means(motor->name());
    if (said || (by_joints && s.joints.means(motor->joint().name()))) motors.push_back(motor.get());
  }
  const bool changed = parts != parts_ || joints != joints_ || motors != motors_;
  resolved_at_ = body.structure_;
  if (changed) {
    if (!id_.null()) world().behaviors().undo().keep_targets(*this);  // else it is being made
    parts_ = std::move(parts);
    joints_ = std::move(joints);
    motors_ = std::move(motors);
    fresh_ = true;
  }
  if (group_ != nullptr) return {};  // bodies by pattern need not have all of the names: the group looks
  if (Result<void> exist = names_exist(body, "part", s.parts, body.parts()); !exist) return exist;
  if (Result<void> exist = names_exist(body, "joint", s.joints, body.joints()); !exist) return exist;
  if (Result<void> exist = names_exist(body, "motor", s.motors, body.motors()); !exist) return exist;
  for (const Joint* joint : joints_) {
    const bool named =
        std::find(s.joints.words().begin(), s.joints.words().end(), joint->name()) != s.joints.words().end();
    if (!by_joints || !named || joint->motor() != nullptr) continue;
    return Error{fmt::format("joint '{}/{}' has no motor; add_motor makes one", body.name(), joint->name())};
  }
  return {};
}

void Behavior::restart() {
  world().behaviors().undo().keep(*this);
  call_attention();
  fresh_ = true;
  seeded_with_ = kNoSeed;
}

// before a step: what a start, a reset or another seed asks for
void Behavior::prepare() {
  if (const std::uint64_t seed = world().seed(); seed != seeded_with_) {
    seeded_with_ = seed;
    random_ = Random(seed, store().path(id_));
  }
  if (!std::exchange(fresh_, false)) return;
  beats_.clear();
  start();
}

std::uint64_t Behavior::state_hash(std::uint64_t hash) const {
  NumberHash numbers(hash_bytes(type_->name, hash_bytes(name(), hash)));
  numbers.add_word(kept_hash(store(), id_));
  if (random_.drawn()) numbers.add(random_.state());
  for (const Beat& beat : beats_) numbers.add(beat.anchor, beat.interval, beat.count);
  return numbers.value();
}

}  // namespace limber
