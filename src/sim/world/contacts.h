// Contacts: contact events and contact points of parts that report contacts, collected over the substeps of a tick.
// [sim]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"
#include "sim/sensors/contact_points.h"

class btDispatcher;
class btManifoldPoint;
class btPersistentManifold;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Part;

enum class ContactPhase : std::uint8_t {
  begin,  ///< Two parts began to touch.
  stay,   ///< They touched in the previous tick and in this one.
  end,    ///< They touched in the previous tick, but not in this one.
};

/// An event of two parts that touch; `part` reports contacts.
struct ContactEvent {
  NodeId part;
  NodeId other;
  /// N·s. Begin: of the impact: sum over the contact's points, each up to and including the step in which it closes;
  /// impulses that carry resting loads afterwards are not included. Stay: all normal impulses of the tick. End: 0.
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
  /// To be called after the last substep: collects the events of the tick, which lasts `seconds`.
  void end_tick(const Store& store, double seconds);
  std::span<const ContactEvent> events(ContactPhase phase = ContactPhase::begin) const {
    return state_.events[static_cast<std::size_t>(phase)];
  }
  /// The contact points of the last tick.
  const ContactPoints& points() const { return points_; }
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
  void add_event(ContactPhase phase, const Pair& pair, double impulse);

  // what persists from tick to tick
  struct State {
    int reporting = 0;
    std::vector<Pair> pairs;                          // in the order in which they first touched
    std::array<std::vector<ContactEvent>, 3> events;  // by phase
  } state_;
  ContactPoints points_;
};

}  // namespace limber::sim
