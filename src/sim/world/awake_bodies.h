// AwakeBodies: the bodies of a world that are not asleep, whose readouts are published after each tick. [sim]
#pragma once

#include <cstdint>
#include <vector>

namespace limber::sim {

class Body;
class World;

class AwakeBodies {
 public:
  explicit AwakeBodies(World& world) : world_(world) {}

  /// Publishes the state of all awake bodies, in parallel; a sleeping body's readouts don't change. Then logs their
  /// warnings and checks their joints.
  void publish();
  /// Makes the next publish() publish all bodies.
  void invalidate() { sleep_version_ = 0; }

 private:
  World& world_;
  std::vector<Body*> bodies_;  // valid for these versions of the sleep tracker and the store; 0: not valid
  std::uint64_t sleep_version_ = 0;
  std::uint64_t structure_version_ = 0;
};

}  // namespace limber::sim
