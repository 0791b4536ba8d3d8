// Where running programs can be found: a socket for each in a folder that belongs to the user alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber {

/// The folders that there are and that are this user's alone (0700), best first: $XDG_RUNTIME_DIR (without one,
/// /run/user/<uid>), limber-<uid> in the temp folder ($TMPDIR, else /tmp). [any]
std::vector<std::string> runtime_folders();

/// The best of them; when there is none, the one in the temp folder is made. The error says what is wrong with it.
/// [any]
Result<std::string> make_runtime_folder();

/// A running program's socket.
struct ConsoleSocket {
  int pid = 0;
  std::string path;
};

/// The path of a program's socket: limber-<pid>.sock. [any]
std::string socket_path(std::string_view folder, int pid);

/// The sockets in a folder behind which somebody listens, by pid. Those of dead programs are removed. [any]
std::vector<ConsoleSocket> console_sockets(const std::string& folder);

/// A non-blocking connection to one of this user's programs. The error says why there is none. [any]
Result<system::Descriptor> connect_console(const std::string& path);

}  // namespace limber
