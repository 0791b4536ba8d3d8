// Definitions for editors: the files of src/script/annotations with the rows of the classes' tables put in.
#pragma once

#include <string>
#include <string_view>

namespace limber {

/// LuaCATS, as lua-language-server reads it. `names`: what Scene::names() says. Lines that begin with one of these are
/// replaced: "---@rows CLASS" by a field for each value of the class, "---@opts CLASS" by those that can be set, as
/// options, "---@action CLASS NAME" by what the action's row says, "---@names" by the names of Lua's own. [any]
std::string annotations(std::string_view names);

}  // namespace limber
