// Watchdog: a thread that stops Lua calls that exceed their CPU time budget. It reads the CPU clock of the calling
// thread, so waiting does not count and a loaded machine stops no innocent call. A virtual machine that is suspended
// for a while does count as computing; therefore a call is stopped only if it computes for the second half of its
// budget after it has answered a ping signal. The signal is one that the process doesn't use
// (system::claim_thread_signal).
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace limber::script {

/// A Lua state under watch: its thread writes call numbers, the watchdog writes the number of a call to stop.
struct Watch {
  /// Called in a signal handler on the thread of the call; must be async-signal-safe.
  void (*stop)(Watch& watch) = nullptr;
  void* owner = nullptr;

  // shared by both threads through std::atomic_ref; plain fields, because the signal handler uses the first four
  std::uint64_t call = 0;           ///< Odd while a call runs.
  std::uint64_t stop_call = 0;      ///< The call to be stopped.
  std::uint64_t pinged_call = 0;    ///< The call that was sent a ping.
  std::uint64_t answered_call = 0;  ///< The call that has answered the ping.
  std::int64_t budget = 0;          ///< CPU time budget of the call, ns.
  std::int64_t clock = 0;           ///< CPU clock of the calling thread (base/system/thread.h).
  std::uint64_t thread = 0;

  /// Marks the begin and end of a call on this thread. Lock-free, no allocation; a few nanoseconds.
  void begin(std::int64_t budget_ns);
  void end();
  /// Ends the call and begins another with a fresh budget.
  void next_call();
  /// True if this call is to be stopped; polled by native code that takes long. [thread of the call]
  bool stop_requested();

  // used by the watchdog only
  std::uint64_t observed_call = 0;  // the call that began, or answered, at clock value `observed_at`
  std::int64_t observed_at = 0;
  bool second_half = false;
};

class Watchdog {
 public:
  /// Returns the process-wide instance; created on first use, destroyed with the last reference. [any]
  static std::shared_ptr<Watchdog> instance();
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// `poll_ns`: max. delay for noticing a new call. [any]
  void add(Watch& watch, std::int64_t poll_ns);
  void remove(Watch& watch);

 private:
  struct Entry {
    Watch* watch;
    std::int64_t poll;
  };

  Watchdog();
  void run();
  std::int64_t check(Watch& watch, std::int64_t poll) const;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Entry> watches_;
  bool end_ = false;
  int signal_ = 0;  // sent to the thread of a call
  std::thread thread_;
};

}  // namespace limber::script
