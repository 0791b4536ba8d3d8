// Generates the manual page from the declared options, so that no option is missing.
#pragma once

#include <string>

#include "app/cli/command_info.h"

namespace limber {

/// Returns limber(1) in the man macros of roff, with all commands on one page. [any]
std::string man_page(const CommandInfo& program);

}  // namespace limber
