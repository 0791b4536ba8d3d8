// Signals: requests to end the program, signal handlers, and signals between threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

namespace limber::system {

using SignalHandler = void (*)(int);

enum class Signal : std::uint8_t {
  none,
  wake,       ///< Sent by wake_thread().
  terminate,  ///< SIGINT, SIGTERM or SIGHUP.
};

/// Blocks SIGINT, SIGTERM, SIGHUP and the signal of wake_thread() in this thread and in threads that it starts;
/// wait_for_signal() returns them. Ignores SIGPIPE and SIGXFSZ, so that writes to a closed pipe or beyond the file size
/// limit only fail, and the signals of timers and terminals. [main]
void block_signals();
/// Waits for the next of these signals; returns Signal::none after the limit. [any]
Signal wait_for_signal(std::chrono::nanoseconds limit);
/// True if a signal has arrived; consumes it. [any]
inline bool signal_arrived() { return wait_for_signal(std::chrono::nanoseconds(0)) != Signal::none; }
/// Makes wait_for_signal() return Signal::wake in that thread (this_thread()). [any]
void wake_thread(std::uint64_t thread);

/// Installs a signal handler; the signal interrupts blocking system calls. [main]
void handle_signal(int signal, SignalHandler handler);
/// Installs a signal handler that runs immediately, at any instruction; system calls are restarted. Bypasses
/// sanitizers, which delay handlers until the next intercepted call. [any]
void handle_signal_immediately(int signal, SignalHandler handler);
/// Installs a handler for SIGUSR2 that runs immediately, in any thread; system calls are restarted. [main]
void on_user_signal(SignalHandler handler);
/// Blocks a signal in this thread, except within wait_ready_or_signal(). [the thread]
void block_signal(int signal);

/// Unblocks a signal in this thread. [the thread]
void unblock_signal(int signal);
/// Blocks all signals in this thread, except those of faults: the handlers of the process run on other threads. [the
/// thread]
void block_process_signals();

/// Installs a handler of a signal between threads, like handle_signal_immediately(), and returns the signal: SIGURG,
/// which is ignored by default, or if the process handles it, the highest real-time signal without a handler. Returns 0
/// if there is none. [any]
int claim_thread_signal(SignalHandler handler);
/// Restores the default action of SIGURG if `handler` is still installed. The handler of a real-time signal remains,
/// because a late one would end the process. [any]
void release_thread_signal(int signal, SignalHandler handler);

/// Calls `use`, which starts or stops a profiler, and returns the handler for SIGPROF that is installed then. Restores
/// the handler and the timer that the process had. [any]
SignalHandler preserve_profile_signal(const std::function<void()>& use);

}  // namespace limber::system
