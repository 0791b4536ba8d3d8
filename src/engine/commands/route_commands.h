// Messages that add and remove routes. A reset executes them again, as overrides. [sim]
#pragma once

#include <span>
#include <string_view>

#include "base/message.h"
#include "engine/commands/outcome.h"
#include "sim/world/world.h"

namespace limber::engine {

/// Executes /route/add or /route/connect (name from to), or /route/remove (name).
Outcome edit_routes(sim::World& world, std::string_view address, std::span<const Arg> args);

}  // namespace limber::engine
