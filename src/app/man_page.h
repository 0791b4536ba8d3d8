// The manual page, made from the declared options, so that it names each of them.
#pragma once

#include <string>

#include "app/command_info.h"

namespace limber {

/// limber(1) in the man macros of roff, all commands on one page. [any]
std::string man_page(const CommandInfo& program);

}  // namespace limber
