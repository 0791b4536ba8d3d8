// Contacts: contact-begin events of parts that report contacts, collected over the substeps of a tick. [sim]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"

class btDispatcher;
class btManifoldPoint;
class btPersistentManifold;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Part;

/// Two parts began to touch; `part` reports contacts.
struct ContactEvent {
  NodeId part;
  NodeId other;
  /// Of the impact, N·s: sum over the contact's points, each up to and including the step in which it closes. Impulses
  /// that carry resting loads afterwards are not included.
  double impulse = 0;
  Vec3 position{0};  ///< World, of the deepest point.
};

class Contacts {
 public:
  void set_reporting(bool on) { state_.reporting += on ? 1 : -1; }
  /// To be called before a part is removed: removes its pairs.
  void remove_part(const Part& part);
  /// To be called before the tick's first substep.
  void begin_tick();
  /// To be called after each substep; costs nothing while no part reports. A speculative contact decelerates an
  /// approaching part before the surfaces meet; its event is delayed until it has closed, but at most to the next tick.
  void collect(btDispatcher& dispatcher);
  /// To be called after the last substep: collects the events of the tick.
  void end_tick();
  std::span<const ContactEvent> events() const { return state_.events; }
  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  struct Pair {
    Part* a;
    Part* b;
    double impulse;
    double distance;
    Vec3 position;
    bool touched_before;
    bool touching;
    bool closing;        // as of the last substep: a point presses but has not closed
    bool event_pending;  // it was closing when the previous tick ended: its event is reported in this tick
    void add(btManifoldPoint& point);
  };
  void collect_points(btPersistentManifold& manifold);
  Pair& pair_of(Part* a, Part* b);

  // what persists from tick to tick
  struct State {
    int reporting = 0;
    std::vector<Pair> pairs;  // in the order in which they first touched
    std::vector<ContactEvent> events;
  } state_;
};

}  // namespace limber::sim
