// ServiceManager: reports the state of this program to a service manager (systemd) by the protocol of sd_notify:
// datagrams of lines such as "READY=1" to the socket in NOTIFY_SOCKET.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "base/system/descriptor.h"

namespace limber::system {

/// Sends notifications to the service manager, if there is one.
class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID and removes them from the environment, so that child processes
  /// don't send messages. [main, before other threads start]
  ServiceManager();

  /// True if a service manager started the program and receives messages. [any]
  bool present() const { return socket_.is_open(); }
  /// The watchdog interval: the manager restarts the program without "WATCHDOG=1" in this time; 0: no watchdog. [any]
  std::chrono::microseconds watchdog() const { return watchdog_; }
  /// Sends one or more lines without blocking. False if they were not sent. [any]
  bool notify(std::string_view lines) const;

 private:
  Descriptor socket_;
  std::string address_;  // a path, or "@name" in the abstract namespace of Linux
  std::chrono::microseconds watchdog_{0};
};

/// True if standard error is systemd's journal, which parses a level at the start of each line: "<3>". [any]
bool standard_error_is_journal();

}  // namespace limber::system
