// The sections of the manual page and of the command-line reference that don't depend on the options: exit codes,
// files, environment.
#pragma once

#include <span>
#include <string_view>

namespace limber::app {

struct ManualEntry {
  std::string_view term;
  std::string_view text;  ///< Plain text.
};

/// Exit codes, the same for all commands.
std::span<const ManualEntry> manual_exit_codes();
/// Files and folders.
std::span<const ManualEntry> manual_files();
/// Environment variables.
std::span<const ManualEntry> manual_environment();

}  // namespace limber::app
