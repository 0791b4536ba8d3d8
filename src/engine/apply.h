// Applying a difference to the live world, between two ticks. What does not differ is not touched: pose, velocity and
// everything of Bullet's stay to the bit, and ids stay. [sim]
#pragma once

#include <functional>
#include <vector>

#include "engine/description.h"
#include "engine/difference.h"

namespace limber {

/// The live things of the description in force, in its order. One that was removed by hand has a stale id.
struct LiveThings {
  std::vector<NodeId> shapes;
  std::vector<NodeId> bodies;
};

/// Of a world that its description was taken from just now.
LiveThings things_of(const World& world);

/// What changes hands in an application.
struct Application {
  World& world;        ///< The live one.
  const World& draft;  ///< The one that `now` was taken from.
  const Description& before;
  const Description& now;
  const Difference& difference;
  /// Told of every row that is set.
  std::function<void(NodeId, const Row&)> on_set = [](NodeId, const Row&) {};
};

/// `things`: of the description before; becomes those of the one now. A thing of the performance (made in a callback)
/// whose name is described now is taken over; one that is described but was removed comes back.
void apply(const Application& application, LiveThings& things);

}  // namespace limber
