// Ending: while it lives, the show ends. Another signal ends the program a quarter of a second later, and once the
// files are whole nobody is waited for long.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace limber {

class Ending {
 public:
  /// Signals are blocked (system::block_signals) in every thread. `late` ends the program. [main]
  explicit Ending(std::function<void()> late);
  ~Ending();
  Ending(const Ending&) = delete;
  Ending& operator=(const Ending&) = delete;

  /// From here on `late` comes in half a second, unless all have come back by then. [main]
  void files_are_whole() { whole_.store(true); }

 private:
  void watch();

  std::function<void()> late_;
  std::atomic<bool> whole_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace limber
