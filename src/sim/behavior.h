// Behavior: what moves a body by itself, tick by tick: forces on its parts, goals for its motors. Built-in types are
// in src/behaviors, Lua's in the script room; both derive from this. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/result.h"
#include "params/store.h"
#include "sim/behavior_type.h"
#include "sim/selection.h"

namespace limber {

class BehaviorGroup;
class KeyBytes;
class Body;
class Joint;
class Motor;
class Part;
class World;

/// Rows that every instance and group has before its parameters: `active`, `time`, `remove`, `place`.
inline constexpr std::uint32_t kCommonBehaviorRows = 4;

/// What a behaviour acts on, as the scene says it. Copies of a body and members of a group share one.
struct BehaviorSetup {
  Selection parts;
  Selection joints;
  Selection motors;
  bool operator==(const BehaviorSetup&) const = default;
};

/// Why a behaviour rests; `file` and `line` where a script says so.
struct BehaviorFault {
  std::string text;
  std::string file;
  int line = 0;
};

class Behavior {
 public:
  static std::vector<Row> common_rows();

  Behavior();
  virtual ~Behavior();
  Behavior(const Behavior&) = delete;
  Behavior& operator=(const Behavior&) = delete;

  /// Before the first step, after each reset, and when its parts, joints or motors have changed.
  virtual void start() {}
  /// Every tick while it is active, before what was set reaches Bullet. `dt`: seconds.
  virtual void step(double dt) = 0;
  /// A group's members at once, called on the first of them; all of them are to be stepped. Left as it is: each by
  /// itself, in order.
  virtual void step_group(std::span<Behavior* const> members, double dt);
  /// Comes in the place of `before`, whose type was renewed: takes what should live on. Values, generator and beats
  /// have been taken already.
  virtual void take_over(Behavior& before);
  /// What it remembers from tick to tick beside its rows, generator and beats: a key state takes it and brings it back.
  virtual void pass_memory(KeyBytes& key);

  // What it is; valid from start() on. One that is removed while it steps has no body any more, and an empty name.
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

  /// What it acts on, in stream order (root to tip), each once; a type that acts on pairs has its parts in the order
  /// in which the scene names them. "all" leaves out parts without mass.
  std::span<Part* const> parts() const { return parts_; }
  std::span<Joint* const> joints() const { return joints_; }
  std::span<Motor* const> motors() const { return motors_; }

  bool active() const;
  /// Why it rests although it is active; empty: it does not. Setting `active`, to whatever, tries again.
  const std::string& error() const { return fault_.text; }
  const BehaviorFault& fault() const { return fault_; }
  /// Whether it is stepped: active, without error, its body in the world.
  bool runs() const;
  /// Its own generator: of the world's seed and its path, anew after a reset and when the seed changes.
  Random& random() { return random_; }
  /// True at the first active tick after start() and then every so many simulated milliseconds (`row`'s value now),
  /// the phase kept; an interval shorter than a tick: at every tick. Once a tick for each row.
  bool due(const Row& row);
  /// Microseconds that the last tick spent on it; of a group's member its share.
  double microseconds() const;

  std::uint64_t state_hash(std::uint64_t start) const;

 protected:
  /// Suspends it with this error, which is said once.
  void fail(BehaviorFault fault);
  /// The parameters' values, by their position in the type's list.
  double number(std::uint32_t parameter) const { return values(parameter)[0]; }
  bool flag(std::uint32_t parameter) const { return values(parameter)[0] != 0; }
  Vec3 vec(std::uint32_t parameter) const {
    const double* const v = values(parameter);
    return {v[0], v[1], v[2]};
  }
  /// A draw between two values, or in the box between two corners, x first; either may be the larger.
  double random_between(double a, double b) { return random_.uniform(a, b); }
  Vec3 random_between(const Vec3& a, const Vec3& b);
  bool due(std::uint32_t parameter) { return due(type_->table->row(kCommonBehaviorRows + parameter)); }
  const double* values(std::uint32_t parameter) const;

 private:
  friend class BehaviorList;
  friend class BehaviorGroup;
  friend class BehaviorUndo;
  friend class WorldKey;
  /// When an interval fired last, counted from an anchor so that no error adds up.
  struct Beat {
    const Row* row = nullptr;
    double anchor = 0;    // s
    double interval = 0;  // s
    double count = 0;
  };

  static constexpr std::uint64_t kNoSeed = ~std::uint64_t{0};  // beyond what the row `seed` takes
  void attach(Body& body, NodeId id, std::shared_ptr<const BehaviorType> type,
              std::shared_ptr<const BehaviorSetup> setup, BehaviorGroup* group);
  Result<void> resolve();
  void restart();
  void prepare();
  /// Whether it starts or rests with an error: its group then looks at each member by itself.
  bool needs_attention() const { return fresh_ || seeded_with_ == kNoSeed || !fault_.text.empty(); }
  void call_attention();
  void read_time(double* out) const;
  void read_place(double* out) const;
  void write_place(const double* in);
  Result<void> refuse_place(const double* in) const;
  Result<void> act_remove(std::span<const double> args);
  static void active_written(void* thing, const Row& row);

  World* world_ = nullptr;
  Body* body_ = nullptr;  // null: removed
  BehaviorGroup* group_ = nullptr;
  NodeId id_;
  std::shared_ptr<const BehaviorType> type_;
  std::shared_ptr<const BehaviorSetup> setup_;
  std::vector<Part*> parts_;
  std::vector<Joint*> joints_;
  std::vector<Motor*> motors_;
  std::vector<Beat> beats_;
  Random random_;
  std::uint64_t seeded_with_ = kNoSeed;
  BehaviorFault fault_;
  double seconds_ = 0;             // of the last tick
  std::uint32_t resolved_at_ = 0;  // the body's structure then
  std::uint32_t place_ = 0;        // as BehaviorList last counted it
  std::uint64_t kept_in_ = 0;      // the guarded call that it was kept in last
  bool fresh_ = true;              // start() is to be called before the next step
};

}  // namespace limber
