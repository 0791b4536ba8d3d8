// Text for Lua sources that the program writes. [any]
#pragma once

#include <string>
#include <string_view>

namespace limber {

/// Returns a Lua string in double quotes that has this value, on one line: control characters and bytes that are not
/// valid UTF-8 are written as \ddd.
std::string lua_string(std::string_view text);

}  // namespace limber
