// Generates completion scripts for shells from the declared options, so that no option is missing.
#pragma once

#include <string>

#include "app/cli/command_info.h"

namespace limber {

/// Returns a bash script that completes `limber`. It depends on no other script. [any]
std::string bash_completion(const CommandInfo& program);

/// Returns a function for zsh's completion system, to be saved as `_limber` in `fpath`. [any]
std::string zsh_completion(const CommandInfo& program);

}  // namespace limber
