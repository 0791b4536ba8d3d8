// Bringing what a difference says of behaviours and groups into a world: types, what goes, what comes, values, order.
// [sim]
#pragma once

#include <string>
#include <vector>

#include "engine/apply.h"
#include "sim/behavior_list.h"

namespace limber {

/// A behaviour that goes because its body is made anew.
struct KeptBehavior {
  std::string body;
  std::string name;
  std::string type;
  BehaviorSetup setup;
  const Table* table = nullptr;
  std::vector<double> values;  ///< The kept block.
};

/// Those of a body that belong to no group.
void keep_behaviors(const Body& body, std::vector<KeptBehavior>& kept);

/// After shapes and bodies have been applied; `bodies`: the live ones, by their number in the description now.
void apply_behaviors(const Application& application, const std::vector<Body*>& bodies,
                     const std::vector<KeptBehavior>& kept);

}  // namespace limber
