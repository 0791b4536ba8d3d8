// `limber console`: a Lua console of the running scene, interactive, from a pipe, or for one expression.
#pragma once

#include <optional>
#include <string>

namespace limber {

/// Options of `console`.
struct ConsoleCommand {
  int pid = 0;                            ///< Process id of the program; 0: the only one that runs.
  std::optional<std::string> expression;  ///< `-e`: evaluate this expression and exit.
};

/// Runs the console. Returns the exit code: 1 if no program is running, or if any evaluation failed (except in an
/// interactive terminal). [main]
int console_command(const ConsoleCommand& command);

}  // namespace limber
