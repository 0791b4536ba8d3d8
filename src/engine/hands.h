// Hands: while one lives, rows that are set are set by a hand: they leave the morphs that move them; and what began
// with begin() can be undone, and stands in the log. [sim]
#pragma once

#include "base/system/clock.h"
#include "engine/change_notes.h"
#include "engine/edits.h"
#include "engine/presets.h"

namespace limber {

class Hands {
 public:
  Hands(World& world, Presets& presets, Edits& edits, ChangeNotes& notes)
      : world_(world), presets_(presets), edits_(edits), notes_(notes) {
    const auto heard = [](void* who, NodeId id, const Row& row, bool later, const double* before) {
      static_cast<Hands*>(who)->heard(id, row, later, before);
    };
    before_ = world.store().listen({heard, this});
  }
  ~Hands() { world_.store().listen(before_); }
  Hands(const Hands&) = delete;
  Hands& operator=(const Hands&) = delete;

  /// What is set from here on is this hand's; before the first call it is the scene's, which is neither undone nor
  /// noted.
  void begin(const Origin& who) {
    begun_ = true;
    edits_.begin(who, world_);
    notes_.begin(who, now_);
  }

 private:
  void heard(NodeId id, const Row& row, bool later, const double* before) {
    presets_.release(id, row);
    if (!begun_) return;
    edits_.heard(world_.store(), id, row, later, before);
    if (!later) notes_.heard(id, row, before);
  }

  World& world_;
  Presets& presets_;
  Edits& edits_;
  ChangeNotes& notes_;
  Store::Listener before_;
  const double now_ = system::clock_seconds();
  bool begun_ = false;
};

}  // namespace limber
