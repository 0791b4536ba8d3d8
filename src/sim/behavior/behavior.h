// Behavior: base class of procedural controllers of a body, which apply forces to its parts and set targets of its
// motors at every tick. Built-in types are in src/sim/behavior/builtin, Lua's in the script module. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/result.h"
#include "properties/store.h"
#include "sim/behavior/behavior_attachment.h"
#include "sim/behavior/behavior_properties.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

/// Reason why a behavior is suspended; with `file` and `line` if it is a script's error.
struct BehaviorFault {
  std::string text;
  std::string file;
  int line = 0;
};

class Behavior : public BehaviorAttachment {
 public:
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

  /// Serializes its whole state, for checkpoints.
  void serialize_all(Archive& archive);

  bool active() const;
  /// The reason why it is suspended although it is active, or empty. Setting `active` to any value clears it.
  const std::string& error() const { return state_.fault.text; }
  const BehaviorFault& fault() const { return state_.fault; }
  /// True if it is stepped: active, without error, its body in the world.
  bool runs() const;
  /// Its own random generator, seeded with the world's seed and the behavior's path; seeded again after a reset and
  /// when the seed changes.
  Random& random() { return state_.random; }
  /// True if the interval in `property` (simulated ms) has elapsed: at the first active tick after start(), and then
  /// once per interval without drift; at every tick if the interval is shorter than a tick. Each property has its own
  /// timer. Call once per tick and property.
  bool interval_elapsed(const Property& property);
  /// Duration of its step in the last tick, in microseconds; for a group's member its share of the group's.
  double step_microseconds() const;

  std::uint64_t state_hash(std::uint64_t start) const;

  static constexpr std::uint64_t kNoSeed = ~std::uint64_t{0};  ///< Not a valid value of the property `seed`.
  /// State of an interval timer. Time is counted in intervals from an anchor, so that rounding errors don't
  /// accumulate.
  struct IntervalTimer {
    const Property* property = nullptr;
    double anchor = 0;    ///< s
    double interval = 0;  ///< s
    double count = 0;
  };
  /// What persists from tick to tick, besides its properties, targets and the state of its type.
  struct State {
    std::vector<IntervalTimer> timers;
    Random random;
    std::uint64_t seeded_with = kNoSeed;
    BehaviorFault fault;
    std::uint32_t resolved_structure = 0;  ///< The body's structure version when its targets were resolved.
    bool needs_start = true;               ///< start() has to be called before the next step.
  };
  // Called by BehaviorList, BehaviorGroup and BehaviorTransaction. [sim]
  /// To be called first: sets its body, type, targets and group (or null). Error: a target doesn't exist.
  Result<void> attach(Body& body, std::shared_ptr<const BehaviorType> type, std::shared_ptr<const BehaviorSetup> setup,
                      BehaviorGroup* group);
  /// Adds its node and adds it to the list of its body.
  void add_node(const std::string& name);
  /// Returns an instance of a reloaded type that takes its place, with its targets, generator and intervals.
  std::unique_ptr<Behavior> make_replacement(const std::shared_ptr<const BehaviorType>& type);
  /// Resolves its targets again if the structure of its body has changed.
  void update_targets();
  /// Requests start() before the next step, with a freshly seeded generator.
  void restart();
  /// To be called before a step: seeds the generator again if the seed has changed, and starts it if necessary.
  void prepare();
  /// True if it has to be started or has an error: its group then handles each member individually.
  bool needs_preparation() const {
    return state_.needs_start || state_.seeded_with == kNoSeed || !state_.fault.text.empty();
  }
  void clear_fault();
  void set_step_seconds(double seconds) { step_seconds_ = seconds; }
  /// Saves its state, once in each guarded call. To be called before it changes.
  void save_for_rollback();
  const State& state() const { return state_; }
  void restore(const State& state);

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
  double random_between(double a, double b) { return state_.random.uniform(a, b); }
  Vec3 random_between(const Vec3& a, const Vec3& b);
  bool interval_elapsed(std::uint32_t parameter) {
    return interval_elapsed(type().table->property(kCommonBehaviorProperties + parameter));
  }
  const double* values(std::uint32_t parameter) const;

 private:
  Result<void> resolve();
  void request_preparation();

  State state_;
  double step_seconds_ = 0;          // real time that its step took in the last tick
  std::uint64_t saved_in_call_ = 0;  // the last guarded call that saved its state
};

}  // namespace limber::sim
