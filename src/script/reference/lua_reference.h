// Writes the Lua reference, docs/reference/lua: one Markdown page per subject, from the annotations, the property
// tables and the examples.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/embedded.h"

namespace limber::script {

struct ReferencePage {
  std::string file;  ///< "body.md"
  std::string text;
};

struct LuaReference {
  std::vector<ReferencePage> pages;
  std::vector<std::string> problems;  ///< Names in `---@see` and `---@example` lines that don't exist.
};

/// Returns the reference. `names`: the result of Scene::names(). [any]
LuaReference lua_reference(std::string_view names);

/// The scenes of src/script/examples in folders by subject, and in behaviors_lua/ the behaviors that some of them use.
/// [any]
std::span<const EmbeddedFile> example_files();

/// Returns the example's scene, which may be in any folder, or null. [any]
const EmbeddedFile* find_example(std::string_view name);

/// Returns the behavior of the same name as the example, or null. [any]
const EmbeddedFile* find_example_behavior(std::string_view name);

}  // namespace limber::script
