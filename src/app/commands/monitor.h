// `limber monitor`: prints the messages that a running program receives and sends, or the values that change.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace limber {

/// Options of `monitor`.
struct MonitorCommand {
  std::string pattern;  ///< Pattern of addresses; empty: all.
  bool changes = false;
  bool only_in = false;
  bool only_out = false;
  int pid = 0;                         ///< Process id of the program; 0: the only one that runs.
  std::optional<std::uint64_t> count;  ///< Exit after this number of lines.
};

/// Runs until the program ends or Ctrl+C. Returns the exit code. [main]
int monitor_command(const MonitorCommand& command);

}  // namespace limber
