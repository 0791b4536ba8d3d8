// The command line: commands, options and their help.
#pragma once

namespace limber::app {

/// Parses the command line and runs the command. Returns the exit code: 0 success, 1 invalid input, 2 usage, 3 the
/// machine. [main]
int run_command_line(int argc, char** argv);

}  // namespace limber::app
