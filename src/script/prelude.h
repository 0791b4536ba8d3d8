// The Lua files of src/script/prelude, which the build puts inside the program.
#pragma once

#include "base/embedded.h"

namespace limber {

using PreludeFile = EmbeddedFile;

/// All of them, sorted by name: the order in which they run; names for tracebacks. [any]
std::span<const PreludeFile> prelude_files();

}  // namespace limber
