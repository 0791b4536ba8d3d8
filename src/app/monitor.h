// `limber monitor`: prints what a running program takes in and sends out, or what changes in it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace limber {

struct MonitorCommand {
  std::string pattern;  ///< Of addresses; empty: all.
  bool changes = false;
  bool only_in = false;
  bool only_out = false;
  int pid = 0;                         ///< Which program; 0: the only one.
  std::optional<std::uint64_t> count;  ///< Ends after so many lines.
};

/// Until the program ends or Ctrl+C. Returns the exit code. [main]
int monitor_command(const MonitorCommand& command);

}  // namespace limber
