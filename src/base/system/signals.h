// Signals: requests to end the program, signal handlers, and signals between threads.
#pragma once

#include <chrono>
#include <cstdint>

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

/// Returns the handler that a profiler has installed for SIGPROF, and disables the signal and its timer. [any]
SignalHandler extract_profile_handler();

}  // namespace limber::system
