// ConsoleClient: the console's end of the connection to a running program: sends requests and reads lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "net/console/protocol.h"
#include "net/console/runtime_folder.h"

namespace limber::console {

class ConsoleClient {
 public:
  explicit ConsoleClient(system::Descriptor connection) : connection_(std::move(connection)) {}

  int fd() const { return connection_.fd(); }
  /// Sends a request, waiting as long as necessary. Returns false if the connection is closed.
  bool send(const ConsoleRequest& request);
  /// Returns the next line; nothing after `wait_ms` milliseconds (-1: no limit), after a signal, and when the
  /// connection is closed.
  std::optional<ConsoleLine> next(int wait_ms);
  /// True if the connection is closed and all lines have been read.
  bool ended() const { return ended_; }

 private:
  bool read_some();
  std::optional<ConsoleLine> next_buffered_line();

  system::Descriptor connection_;
  std::string input_;
  bool ended_ = false;
};

/// A running program and the scene from its first line (or the reason why it did not answer).
struct RunningProgram {
  ConsoleSocket socket;
  std::string scene;
};

/// Returns this user's running programs from all runtime folders. [main]
std::vector<RunningProgram> running_programs();

/// A connection to a program, and the first line that it has sent.
struct ConnectedProgram {
  ConsoleClient client;
  ConsoleLine hello;
};

/// Connects to the program with this pid, or with pid 0 to the only one running. The error lists the running programs.
/// [main]
Result<ConnectedProgram> connect_to_program(int pid);

}  // namespace limber::console
