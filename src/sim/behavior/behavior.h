// Behavior: base class of procedural controllers of a body, which apply forces to its parts and set targets of its
// motors at every tick. Built-in types are in src/sim/behavior/builtin, Lua's in the script module. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/result.h"
#include "properties/store.h"
#include "sim/behavior/behavior_type.h"
#include "sim/behavior/selection.h"

namespace limber {

class BehaviorGroup;
class Archive;
class Body;
class Joint;
class Motor;
class Part;
class World;

/// Number of properties that every instance and group has before its parameters: `active`, `time`, `remove`, `place`.
inline constexpr std::uint32_t kCommonBehaviorProperties = 4;

/// The targets of a behavior, as selected by the scene. Copies of a body and members of a group share one object.
struct BehaviorSetup {
  Selection parts;
  Selection joints;
  Selection motors;
  bool operator==(const BehaviorSetup&) const = default;
};

/// Reason why a behavior is suspended; with `file` and `line` if it is a script's error.
struct BehaviorFault {
  std::string text;
  std::string file;
  int line = 0;
};

class Behavior {
 public:
  static std::vector<Property> common_properties();

  Behavior();
  virtual ~Behavior();
  Behavior(const Behavior&) = delete;
  Behavior& operator=(const Behavior&) = delete;

  /// Called before the first step, after each reset, and when its parts, joints or motors have changed.
  virtual void start() {}
  /// Called at every tick while it is active, before changed properties reach Bullet. `dt`: seconds.
  virtual void step(double dt) = 0;
  /// Steps all members of a group; called on the first of them. The default steps each by itself, in order.
  virtual void step_group(std::span<Behavior* const> members, double dt);
  /// Called on the instance that replaces `previous` after its type was reloaded, to copy further state. Values, random
  /// generator and intervals have been copied already.
  virtual void adopt_state(Behavior& previous);
  /// Serializes its state beyond properties, random generator and intervals, for checkpoints.
  virtual void serialize(Archive& archive);

  // Identity, valid from start() on. A behavior that is removed while it steps has no body and an empty name.
  NodeId id() const { return id_; }
  const std::string& name() const;
  Body& body() const { return *body_; }
  World& world() const { return *world_; }
  Store& store() const;
  bool removed() const { return body_ == nullptr; }
  const BehaviorType& type() const { return *type_; }
  /// The group that it is a member of, or null.
  BehaviorGroup* group() const { return group_; }
  const BehaviorSetup& setup() const { return *setup_; }

  /// Its targets in stream order (root to tip), without duplicates; a type that acts on pairs has its parts in the
  /// order in which the scene names them. "all" leaves out parts without mass.
  std::span<Part* const> parts() const { return parts_; }
  std::span<Joint* const> joints() const { return joints_; }
  std::span<Motor* const> motors() const { return motors_; }

  bool active() const;
  /// The reason why it is suspended although it is active, or empty. Setting `active` to any value clears it.
  const std::string& error() const { return fault_.text; }
  const BehaviorFault& fault() const { return fault_; }
  /// True if it is stepped: active, without error, its body in the world.
  bool runs() const;
  /// Its own random generator, seeded with the world's seed and the behavior's path; seeded again after a reset and
  /// when the seed changes.
  Random& random() { return random_; }
  /// True if the interval in `property` (simulated ms) has elapsed: at the first active tick after start(), and then
  /// once per interval without drift; at every tick if the interval is shorter than a tick. Each property has its own
  /// timer. Call once per tick and property.
  bool interval_elapsed(const Property& property);
  /// Duration of its step in the last tick, in microseconds; for a group's member its share of the group's.
  double step_microseconds() const;

  std::uint64_t state_hash(std::uint64_t start) const;

 protected:
  /// Suspends it with this error, which is reported once.
  void fail(BehaviorFault fault);
  /// Values of the parameters, by their index in the type's list.
  double number(std::uint32_t parameter) const { return values(parameter)[0]; }
  bool flag(std::uint32_t parameter) const { return values(parameter)[0] != 0; }
  Vec3 vec(std::uint32_t parameter) const {
    const double* const v = values(parameter);
    return {v[0], v[1], v[2]};
  }
  /// Random value between two values, or random point in the box between two corners (x is drawn first). The bounds
  /// may be in any order.
  double random_between(double a, double b) { return random_.uniform(a, b); }
  Vec3 random_between(const Vec3& a, const Vec3& b);
  bool interval_elapsed(std::uint32_t parameter) {
    return interval_elapsed(type_->table->property(kCommonBehaviorProperties + parameter));
  }
  const double* values(std::uint32_t parameter) const;

 private:
  friend class BehaviorList;
  friend class BehaviorGroup;
  friend class BehaviorTransaction;
  friend class WorldCheckpoint;
  /// State of an interval timer. Time is counted in intervals from an anchor, so that rounding errors don't
  /// accumulate.
  struct IntervalTimer {
    const Property* property = nullptr;
    double anchor = 0;    // s
    double interval = 0;  // s
    double count = 0;
  };

  static constexpr std::uint64_t kNoSeed = ~std::uint64_t{0};  // not a valid value of the property `seed`
  void attach(Body& body, NodeId id, std::shared_ptr<const BehaviorType> type,
              std::shared_ptr<const BehaviorSetup> setup, BehaviorGroup* group);
  Result<void> resolve();
  void restart();
  void prepare();
  /// True if it has to be started or has an error: its group then handles each member individually.
  bool needs_preparation() const { return needs_start_ || seeded_with_ == kNoSeed || !fault_.text.empty(); }
  void request_preparation();
  void read_time(double* out) const;
  void read_place(double* out) const;
  void write_place(const double* in);
  Result<void> validate_place(const double* in) const;
  Result<void> act_remove(std::span<const double> args);
  static void on_active_written(void* object, const Property& property);

  World* world_ = nullptr;
  Body* body_ = nullptr;  // null: removed
  BehaviorGroup* group_ = nullptr;
  NodeId id_;
  std::shared_ptr<const BehaviorType> type_;
  std::shared_ptr<const BehaviorSetup> setup_;
  std::vector<Part*> parts_;
  std::vector<Joint*> joints_;
  std::vector<Motor*> motors_;
  std::vector<IntervalTimer> timers_;
  Random random_;
  std::uint64_t seeded_with_ = kNoSeed;
  BehaviorFault fault_;
  double step_seconds_ = 0;               // duration of the last tick
  std::uint32_t resolved_structure_ = 0;  // the body's structure counter when its targets were resolved
  std::uint32_t place_ = 0;               // as computed by the last BehaviorList::compute_places()
  std::uint64_t saved_in_call_ = 0;       // the last guarded call that saved its state
  bool needs_start_ = true;               // start() has to be called before the next step
};

}  // namespace limber
