// The Lua files of src/script/prelude, which the build embeds in the program.
#pragma once

#include "base/embedded.h"

namespace limber {

using PreludeFile = EmbeddedFile;

/// All files, sorted by name, which is the order in which they run; the names appear in tracebacks. [any]
std::span<const PreludeFile> prelude_files();

}  // namespace limber
