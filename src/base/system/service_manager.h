// ServiceManager: what a service manager (systemd) is told about this program, by the protocol of sd_notify: each
// message is a datagram of lines such as "READY=1", to the socket that NOTIFY_SOCKET names.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "base/system/descriptor.h"

namespace limber::system {

class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID, and removes them, so that child processes don't answer in the
  /// program's place. [main, before other threads start]
  ServiceManager();

  /// Whether one has started the program and waits for messages. [any]
  bool present() const { return socket_.open(); }
  /// It restarts the program when "WATCHDOG=1" is missing for this long; 0: it doesn't. [any]
  std::chrono::microseconds watchdog() const { return watchdog_; }
  /// Sends one or more lines. Never waits; false: not sent. [any]
  bool notify(std::string_view lines) const;

 private:
  Descriptor socket_;
  std::string address_;  // a path, or "@name" in the abstract namespace of Linux
  std::chrono::microseconds watchdog_{0};
};

/// Whether standard error is a stream of systemd's journal, which reads a level in front of each line: "<3>". [any]
bool standard_error_is_journal();

}  // namespace limber::system
