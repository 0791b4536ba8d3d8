// The Lua files of src/script/prelude, which the build puts inside the program.
#pragma once

#include <span>
#include <string_view>

namespace limber {

struct PreludeFile {
  std::string_view name;  ///< The file's name, `10_values.lua` say, for tracebacks.
  std::string_view text;  ///< Its whole text, for the life of the program.
};

/// All of them, sorted by name: the order in which they run. [any]
std::span<const PreludeFile> prelude_files();

}  // namespace limber
