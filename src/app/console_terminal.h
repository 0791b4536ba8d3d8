// The console at a terminal: a line editor with history and completion, over a session.
#pragma once

#include "console/console_link.h"

namespace limber {

/// Until the person leaves (Ctrl+D) or the program ends. Returns the exit code. [main]
int console_terminal(ConsoleLink link, const ConsoleLine& hello);

}  // namespace limber
