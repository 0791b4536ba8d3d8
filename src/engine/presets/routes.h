// Routes in presets: a preset contains the routes that exist when it is stored, so that a recall can add them again.
// [sim]
#pragma once

#include <vector>

#include "engine/presets/preset.h"
#include "sim/world/world.h"

namespace limber::engine {

/// Returns the routes whose settings are in the schema.
std::vector<PresetRoute> routes_of(const sim::World& world, const PresetSchema& schema);
/// Adds the routes of the presets that do not exist, and gives the others the addresses that they have in the preset.
void restore_routes(sim::World& world, const Blend& blend);

}  // namespace limber::engine
