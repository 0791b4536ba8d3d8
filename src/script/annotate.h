// Generates the LuaCATS definitions for editors: the files of src/script/annotations plus the properties of all
// classes.
#pragma once

#include <string>
#include <string_view>

namespace limber::script {

/// Returns the definitions as lua-language-server reads them. `names`: the result of Scene::names(). Replaces lines
/// that begin with "---@properties CLASS" (one field per property of the class), "---@opts CLASS" (the writable ones,
/// as options), "---@action CLASS NAME" (the action's description) and "---@names" (names of Lua's own libraries).
/// [any]
std::string annotations(std::string_view names);

}  // namespace limber::script
