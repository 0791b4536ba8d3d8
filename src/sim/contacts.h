// Contacts: which reporting parts began to touch, gathered over a tick's internal steps. [sim]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"
#include "sim/bullet.h"

namespace limber {

class Part;

/// Two parts began to touch; `part` asked for reports.
struct ContactEvent {
  NodeId part;
  NodeId other;
  double impulse =
      0;  ///< Of the impact, N·s: the sum over its points until each has closed, without what they carry then.
  Vec3 position{0};  ///< World, of the deepest point.
};

class Contacts {
 public:
  void part_reports(bool on) { reporting_ += on ? 1 : -1; }
  /// A part is about to go: forget its pairs.
  void forget(const Part& part);
  /// Before the tick's first internal step.
  void begin_tick();
  /// After each internal step: costs nothing while no part reports. A contact slows an approaching part down in the
  /// step before it closes; an event waits for that, by a tick if the tick ends in between.
  void gather(btDispatcher& dispatcher);
  /// After the last: what began to touch.
  void end_tick();
  std::span<const ContactEvent> begun() const { return begun_; }

 private:
  friend class WorldKey;
  struct Pair {
    Part* a;
    Part* b;
    double impulse;
    double depth;
    Vec3 position;
    bool before;
    bool now;
    bool closing;  // after the last internal step: a point has begun to press but has not closed
    bool waits;    // it was so when the tick before ended; its event comes with this one
  };
  Pair& pair_of(Part* a, Part* b);

  int reporting_ = 0;
  std::vector<Pair> pairs_;  // in the order in which they first touched
  std::vector<ContactEvent> begun_;
};

}  // namespace limber
