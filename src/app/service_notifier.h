// ServiceNotifier: keeps a service manager informed about the show, so that it restarts a program that hangs.
#pragma once

#include <chrono>
#include <string>

#include "base/system/service_manager.h"

namespace limber {

class ServiceNotifier {
 public:
  using Clock = std::chrono::steady_clock;
  /// Loading may take this long in total before the service manager gives up.
  static constexpr std::chrono::minutes kLongestLoad{10};

  /// [main, before other threads start]
  ServiceNotifier() = default;

  bool present() const { return manager_.present(); }
  /// The scene is being read: extends the time limit of the start. Called at least every five seconds. [main]
  void loading(Clock::time_point now = Clock::now());
  /// One turn of the simulation's loop. The first reports that the show plays; the others feed the watchdog, a few
  /// times in each of its intervals. Never waits. [sim]
  void turn(Clock::time_point now = Clock::now());
  /// The show ends. [main]
  void stopping() const { (void)manager_.notify("STOPPING=1"); }
  /// A line about the show, for `systemctl status`. [main]
  void status(const std::string& line) const;

 private:
  void ready(Clock::time_point now);

  system::ServiceManager manager_;
  const Clock::time_point begun_ = Clock::now();
  bool ready_ = false;     // [sim]
  Clock::time_point fed_;  // [sim]
};

}  // namespace limber
