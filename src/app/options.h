// The command line: commands, their options, and help that teaches.
#pragma once

namespace limber {

/// Parses and runs; returns the exit code: 0 fine, 1 the input is at fault, 2 usage, 3 the machine. [main]
int run_command_line(int argc, char** argv);

}  // namespace limber
