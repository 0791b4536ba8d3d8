// The interactive console: a line editor with history and completion on top of a ConsoleSession.
#pragma once

#include "net/console/console_client.h"

namespace limber::app {

/// Runs until the user leaves (Ctrl+D) or the program ends. Returns the exit code. [main]
int console_terminal(console::ConnectedProgram program);

}  // namespace limber::app
