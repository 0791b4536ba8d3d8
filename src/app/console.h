// `limber console`: a Lua console of the running scene, at a terminal, from a pipe, or for one expression.
#pragma once

#include <optional>
#include <string>

namespace limber {

struct ConsoleCommand {
  int pid = 0;                            ///< Which program; 0: the only one.
  std::optional<std::string> expression;  ///< `-e`: evaluate this and end.
};

/// Returns the exit code: 1 when there is no program to talk to, or when (without a terminal) anything had an error.
/// [main]
int console_command(const ConsoleCommand& command);

}  // namespace limber
