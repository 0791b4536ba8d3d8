// Converts OSC addresses to Lua expressions.
#pragma once

#include <string>
#include <string_view>

#include "properties/tree_snapshot.h"

namespace limber::panel {

/// Returns `sim:body("arm"):part("tip").mass` for /physics/body/arm/part/tip/mass; empty if Lua has no equivalent.
/// [any]
std::string lua_path(const TreeSnapshot& tree, const TreePropertyRef& ref);

/// Returns a name as a quoted Lua string. Names contain no control characters.
std::string lua_text(std::string_view name);

}  // namespace limber::panel
