// Applies the differences of behaviors and groups to the live world: types, removed and added ones, values, order.
// [sim]
#pragma once

#include <string>
#include <vector>

#include "engine/reload/scene_patch.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine {

/// The saved state of a behavior that is removed because its body is rebuilt.
struct SavedBehavior {
  std::string body;
  std::string name;
  std::string type;
  sim::BehaviorSetup setup;
  const PropertyTable* table = nullptr;
  std::vector<double> values;  ///< Its persistent values.
};

/// Appends the behaviors of a body that belong to no group.
void save_behaviors(const sim::Body& body, std::vector<SavedBehavior>& saved);

/// Call it after shapes and bodies have been applied. `bodies`: the live ones, in the order of the new spec.
void apply_behaviors(const ScenePatch& patch, const std::vector<sim::Body*>& bodies,
                     const std::vector<SavedBehavior>& saved);

}  // namespace limber::engine
