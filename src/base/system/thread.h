// Threads: start, name, processor time, priority, signals.
#pragma once

#include <cstdint>
#include <system_error>
#include <thread>
#include <utility>

namespace limber::system {

/// Starts a thread. False if the system can't start another one, or has no memory for its stack. [any]
template <class Run>
bool start_thread(std::thread& thread, Run&& run) {
  try {
    thread = std::thread(std::forward<Run>(run));
  } catch (const std::system_error&) {
    return false;
  }
  return true;
}

/// Sets the name that debuggers and process lists show, at most 15 bytes. [any]
void name_this_thread(const char* name);

/// Returns an id of this thread for signal_thread(). [any]
std::uint64_t this_thread();
/// Sends a signal to a thread of this program. [any]
void signal_thread(std::uint64_t thread, int signal);

/// Returns the processor clock of this thread, for cpu_nanoseconds() in any thread. [any]
std::int64_t this_thread_clock();
/// Returns the processor time of a thread in ns, or -1 if it has ended. [any]
std::int64_t cpu_nanoseconds(std::int64_t clock);

/// Lowers the priority of this thread and of threads that it starts, if the system has thread priorities. [any]
void lower_thread_priority();

}  // namespace limber::system
