// ServiceNotifier: reports the state of the show to the service manager, so that it restarts a program that hangs.
#pragma once

#include <chrono>
#include <string>

#include "base/system/service_manager.h"

namespace limber::app {

/// The connection to systemd's service manager, if the program runs as a service.
class ServiceNotifier {
 public:
  using Clock = std::chrono::steady_clock;
  /// Maximal extension of the startup time limit.
  static constexpr std::chrono::minutes kMaxLoadTime{10};

  /// [main, before other threads start]
  ServiceNotifier() = default;

  /// True if the program runs as a service.
  bool present() const { return manager_.present(); }
  /// Extends the startup time limit while the scene loads. Must be called at least every five seconds. [main]
  void loading(Clock::time_point now = Clock::now());
  /// Called in each iteration of the simulation loop. The first call reports that the show plays; later ones feed the
  /// watchdog, a few times per interval. Never blocks. [sim]
  void on_iteration(Clock::time_point now = Clock::now());
  /// Reports that the show ends. [main]
  void stopping() const { (void)manager_.notify("STOPPING=1"); }
  /// Sets the line that `systemctl status` shows. [main]
  void status(const std::string& line) const;

 private:
  void ready(Clock::time_point now);

  system::ServiceManager manager_;
  const Clock::time_point start_time_ = Clock::now();
  bool ready_ = false;          // [sim]
  Clock::time_point last_fed_;  // [sim]
};

}  // namespace limber::app
