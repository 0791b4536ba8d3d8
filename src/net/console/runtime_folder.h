// Discovery of running programs: each has a socket in a folder that only its user can access.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::console {

/// Returns the existing folders that only this user can access (0700), in order of preference: $XDG_RUNTIME_DIR (if
/// unset, /run/user/<uid>), then limber-<uid> in the folder for temporary files ($TMPDIR, else /tmp). [any]
std::vector<std::string> runtime_folders();

/// Returns the preferred runtime folder; if none exists, creates the one for temporary files. [any]
Result<std::string> make_runtime_folder();

/// The socket of a running program.
struct ConsoleSocket {
  int pid = 0;
  std::string path;
};

/// Returns the path of a program's socket: limber-<pid>.sock. [any]
std::string socket_path(std::string_view folder, int pid);

/// Returns the sockets in a folder that have a listener, sorted by pid. Removes sockets of programs that have exited.
/// [any]
std::vector<ConsoleSocket> console_sockets(const std::string& folder);

/// Returns a non-blocking connection to a program of this user. [any]
Result<system::Descriptor> connect_console(const std::string& path);

}  // namespace limber::console
