// Signals: those that end a program, those that a handler takes, and those that one thread sends to another.
#pragma once

#include <chrono>
#include <cstdint>

namespace limber::system {

using SignalHandler = void (*)(int);

enum class Signal : std::uint8_t {
  none,
  call,  ///< By call_thread().
  end,   ///< SIGINT, SIGTERM or SIGHUP.
};

/// From here on SIGINT, SIGTERM and SIGHUP, and calls of call_thread(), are kept until wait_for_signal() returns them,
/// in every thread that starts later too. A pipe that closes and a file that may not grow are errors of the call alone;
/// signals of timers and terminals have no effect. [main]
void block_signals();
/// The next of these signals, or none within the limit. [any]
Signal wait_for_signal(std::chrono::nanoseconds limit);
/// Whether one has come until now; it is fetched. [any]
inline bool signal_came() { return wait_for_signal(std::chrono::nanoseconds(0)) != Signal::none; }
/// Ends a wait_for_signal() of that thread (this_thread()) with Signal::call. [any]
void call_thread(std::uint64_t thread);

/// Calls the handler at a signal; system calls that wait end early. [main]
void handle_signal(int signal, SignalHandler handler);
/// The same, but the handler runs at any instruction, and system calls continue afterwards. Bypasses sanitizers, which
/// delay handlers until the next intercepted call. [any]
void handle_signal_at_once(int signal, SignalHandler handler);
/// Calls the handler at SIGUSR2, at any instruction of any thread; system calls continue afterwards. [main]
void on_user_signal(SignalHandler handler);
/// Keeps a signal out, except in wait_ready_or_signal(). [the thread]
void block_signal(int signal);

/// The handler that a profiler has installed for SIGPROF. The signal and its timer are switched off. [any]
SignalHandler take_profile_handler();

}  // namespace limber::system
