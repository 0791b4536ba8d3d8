// Threads: their names, processor time, priority, and signals to one of them.
#pragma once

#include <cstdint>
#include <system_error>
#include <thread>
#include <utility>

namespace limber::system {

/// Starts a thread; false: the system has none left, or no memory for its stack. [any]
template <class Run>
bool start_thread(std::thread& thread, Run&& run) {
  try {
    thread = std::thread(std::forward<Run>(run));
  } catch (const std::system_error&) {
    return false;
  }
  return true;
}

/// The name that debuggers and process lists show, at most 15 bytes. [any]
void name_this_thread(const char* name);

/// Identifies a running thread for signal_thread(). [any]
std::uint64_t this_thread();
/// Sends a signal to a thread of this program. [any]
void signal_thread(std::uint64_t thread, int signal);

/// The processor clock of this thread, for cpu_nanoseconds() in any thread. [any]
std::int64_t this_thread_clock();
/// Processor time of a thread; -1: it has ended. [any]
std::int64_t cpu_nanoseconds(std::int64_t clock);

/// Lowers the priority of this thread, and of threads that it starts, below the others of the program, where the
/// system has priorities of threads. [any]
void lower_thread_priority();

}  // namespace limber::system
