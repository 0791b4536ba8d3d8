// What the program's commands end with, as --help says: by these a script that calls them knows what to do.
#pragma once

#include <string_view>

namespace limber {

inline constexpr int kFine = 0;
inline constexpr int kInput = 1;    ///< What was given (a scene, a model, an answer) is at fault.
inline constexpr int kUsage = 2;    ///< The command line is.
inline constexpr int kMachine = 3;  ///< The machine is: a port in use, a folder that can't be written.

/// Says on stderr what went wrong, unprintable bytes escaped, and gives the code back.
int fail(int code, std::string_view text);

/// Writes all text that is queued. Returns the code, or 3 where a result could not be written to stdout; a reader that
/// has closed it is no failure. [main]
int finish_command(int code);
/// The same, and ends the program without destroying anything. [any]
[[noreturn]] void end_program(int code);

}  // namespace limber
