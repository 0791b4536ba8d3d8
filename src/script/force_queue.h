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
  /// What is there came from calls that ended well: it stays. Most of the time it waits on, for others to come.
  void commit(PartLoads& loads);
  /// Gives what stays to its parts, in the order in which it came. Parts that are gone are passed over.
  void apply_committed(PartLoads& loads);
  /// Gives all to their parts.
  void apply(PartLoads& loads);
  /// The same in the middle of a call, which may still fail.
  void apply_kept(World& world);
  /// Forgets what came since commit().
  void take_back() { view_.count = committed_; }

 private:
  void give(std::int32_t from, std::int32_t to, PartLoads& loads) const;

  std::vector<LimberForce> entries_;
  std::int32_t committed_ = 0;  // so many of the entries stay
  LimberForces view_{};
};

}  // namespace limber
