// Watchdog: a thread that reads the CPU clock of the thread that runs Lua, and stops a call that takes too long. What
// is measured is computing, never waiting: a loaded machine stops nobody who is innocent. A virtual machine whose
// processor was taken away for a while counts that as computing, so a call is stopped only if it computes for the
// second half of its budget after it has answered a signal: who was away answers when back, and then ends in time.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace limber {

/// One Lua state under watch: its thread writes the numbers of calls, the watchdog the number of a call to be stopped.
struct Watch {
  /// Called on the thread of the call, from a signal: must only do what a signal handler may.
  void (*stop)(Watch& watch) = nullptr;
  void* owner = nullptr;

  // shared by the two threads: through std::atomic_ref only; plain, because a signal handler uses the first four
  std::uint64_t call = 0;      ///< Odd while a call runs.
  std::uint64_t asked = 0;     ///< The call that is to be stopped.
  std::uint64_t hailed = 0;    ///< The call that is to answer.
  std::uint64_t answered = 0;  ///< The call that has answered.
  std::int64_t budget = 0;     ///< CPU time of the call, ns.
  std::int64_t clock = 0;      ///< Of the thread that runs the call (base/system/thread.h).
  std::uint64_t thread = 0;

  /// A call begins and ends on this thread. No lock, no allocation; a few nanoseconds.
  void begin(std::int64_t budget_ns);
  void end();
  /// In the middle of a call: another begins, with the budget anew.
  void next();
  /// Whether this call is to be stopped: for native code that works on for long. [thread of the call]
  bool stop_asked();

  // the watchdog's own
  std::uint64_t seen = 0;  // the call that began, or answered, when the clock showed `since`
  std::int64_t since = 0;
  bool second_half = false;
};

class Watchdog {
 public:
  /// The process's one, started by the first who asks and ended when nobody holds it. [any]
  static std::shared_ptr<Watchdog> instance();
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// `poll_ns`: how soon a call that begins must be noticed. [any]
  void add(Watch& watch, std::int64_t poll_ns);
  void remove(Watch& watch);

 private:
  struct Watched {
    Watch* watch;
    std::int64_t poll;
  };

  Watchdog();
  void run();
  static std::int64_t look(Watch& watch, std::int64_t poll);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Watched> watches_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace limber
