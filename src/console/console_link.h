// ConsoleLink: a console's end of the connection to a running program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "console/protocol.h"
#include "console/runtime_folder.h"

namespace limber {

class ConsoleLink {
 public:
  explicit ConsoleLink(system::Descriptor connection) : connection_(std::move(connection)) {}

  int fd() const { return connection_.fd(); }
  /// False when the other end has gone.
  bool send(const ConsoleRequest& request);
  /// The next line that has come; nothing when none does within `wait_ms` (-1: however long), after a signal, and when
  /// the other end has gone.
  std::optional<ConsoleLine> next(int wait_ms);
  /// The other end has gone, and all that it said was read.
  bool ended() const { return ended_; }

 private:
  bool read_some();
  std::optional<ConsoleLine> take_line();

  system::Descriptor connection_;
  std::string in_;
  bool ended_ = false;
};

/// A running program, as its first line tells.
struct RunningProgram {
  ConsoleSocket socket;
  std::string scene;
};

/// Those of this user, in every runtime folder. [main]
std::vector<RunningProgram> running_programs();

/// The connection to one of them: the one with that pid, or with 0 the only one. `hello` gets its first line. The error
/// says which ones there are and how to choose. [main]
Result<ConsoleLink> choose_program(int pid, ConsoleLine& hello);

}  // namespace limber
