// ForceQueue: forces and torques that a guarded call gives to parts. Compiled Lua writes them here without a call; they
// reach the parts when the call has ended well, and are forgotten when it fails. [sim]
#pragma once

#include <vector>

#include "script/c_api.h"

namespace limber {

class PartLoads;
class World;

class ForceQueue {
 public:
  ForceQueue();
  /// As the prelude sees it: entries, how many there are, how many there can be.
  LimberForces* view() { return &view_; }
  /// Room for more; false: there can't be, apply() makes some.
  bool grow();
  /// Gives all to their parts, in the order in which they came. Parts that are gone are passed over.
  void apply(PartLoads& loads);
  /// The same in the middle of a call, which may still fail.
  void apply_kept(World& world);
  void clear() { view_.count = 0; }

 private:
  std::vector<LimberForce> entries_;
  LimberForces view_{};
};

}  // namespace limber
