// How a script says what an address says.
#pragma once

#include <string>
#include <string_view>

#include "params/tree.h"

namespace limber {

/// `sim:body("arm"):part("tip").mass` for /physics/body/arm/part/tip/mass; empty: scripts have no such name. [any]
std::string lua_path(const Tree& tree, const TreePlace& place);

/// A name as Lua writes it, in quotes. Names have no control characters.
std::string lua_text(std::string_view name);

}  // namespace limber
