// Exit codes of the program's commands, as documented in --help, so that scripts can react to them.
#pragma once

#include <string_view>

namespace limber::app {

inline constexpr int kSuccess = 0;
inline constexpr int kInputError = 1;    ///< The input is invalid: a scene, a model, an answer.
inline constexpr int kUsageError = 2;    ///< The command line is invalid.
inline constexpr int kMachineError = 3;  ///< A problem of the machine: a port is in use, a folder is not writable.

/// Prints an error to stderr, with unprintable bytes escaped, and returns `code`.
int fail(int code, std::string_view text);

/// Flushes all queued output. Returns `code`, or 3 if a result could not be written to stdout. A reader that closed the
/// pipe is not an error. [main]
int finish_command(int code);
/// Calls finish_command(), then ends the program without running destructors. [any]
[[noreturn]] void end_program(int code);

}  // namespace limber::app
