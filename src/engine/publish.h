// Publisher: makes the snapshot after each tick, and the roster when bodies come and go. [sim]
#pragma once

#include <memory>

#include "base/latest.h"
#include "engine/snapshot.h"
#include "sim/world.h"

namespace limber {

class Publisher {
 public:
  Publisher(World& world, Latest<Snapshot>& out) : world_(world), out_(out) {}

  void publish(bool paused, double speed_reached, const PhaseTimes& times = {});

 private:
  void renew_roster();

  World& world_;
  Latest<Snapshot>& out_;
  std::shared_ptr<const Roster> roster_;
  std::shared_ptr<const Drawing> drawing_;
  std::uint64_t structure_ = 0;
};

}  // namespace limber
