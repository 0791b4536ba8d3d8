// Completion scripts for shells, made from the declared options, so that they name each of them.
#pragma once

#include <string>

#include "app/command_info.h"

namespace limber {

/// A script for bash that completes `limber`. It needs no other script. [any]
std::string bash_completion(const CommandInfo& program);

/// A function for zsh's completion system, for a file `_limber` in its `fpath`. [any]
std::string zsh_completion(const CommandInfo& program);

}  // namespace limber
