// ScenePatch: applies a scene diff to the live world, between two ticks. Unchanged objects are not touched: their pose,
// velocity, Bullet state and ids stay identical to the bit. [sim]
#pragma once

#include <functional>
#include <vector>

#include "engine/reload/scene_diff.h"
#include "engine/reload/scene_spec.h"

namespace limber::engine {

/// Ids of the live objects of the current spec, in its order. An object that was removed since has a stale id.
struct LiveObjects {
  std::vector<NodeId> shapes;
  std::vector<NodeId> bodies;
};

/// Returns the ids of all objects of a world that was captured as a spec just now.
LiveObjects live_objects_of(const sim::World& world);

/// The input of apply().
struct ScenePatch {
  sim::World& world;            ///< The live world.
  const sim::World& candidate;  ///< The world of the new run, from which `now` was captured.
  const SceneSpec& before;
  const SceneSpec& now;
  const SceneDiff& diff;
  /// Called for every property that is set.
  std::function<void(NodeId, const Property&)> on_set = [](NodeId, const Property&) {};
};

/// Applies a patch. `objects`: in, the objects of the old spec; out, those of the new spec. An unmanaged object (made
/// in a callback) with the name of a new one becomes managed. An object of the spec that was removed is added again.
void apply(const ScenePatch& patch, LiveObjects& objects);

}  // namespace limber::engine
