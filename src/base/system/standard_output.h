// Standard output and standard error: writes with a time limit, and replacement of descriptors that were closed at
// startup.
#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>

namespace limber::system {

constexpr int kStandardOutput = 1;
constexpr int kStandardError = 2;

/// Opens a placeholder for each of the descriptors 0 to 2 that is closed at startup. Otherwise the next opened file or
/// socket would get its number, and output would be written into it. Reading from or writing to a placeholder fails
/// with EBADF. Also makes writes to a closed pipe fail with EPIPE, without a signal. [main, before anything is opened]
void prepare_standard_descriptors();

struct Written {
  std::size_t count = 0;  ///< Bytes.
  int error = 0;          ///< The errno. EAGAIN: not writable within the limit. EINTR: a signal arrived.
};

/// Waits at most `limit` for the descriptor to be writable, then writes at most 4 KiB. A writable pipe, socket or
/// terminal accepts this much without blocking, unless another program fills it at the same moment. [any]
Written write_within(int fd, std::string_view bytes, std::chrono::nanoseconds limit);

/// Blocks all signals in this thread, so that a closed pipe, a full disk and a background terminal are only errors of
/// write_within(). [the thread]
void block_all_signals();

/// True if SIGINT, SIGTERM or SIGHUP is blocked (block_signals()) and pending. Does not consume it. [any]
bool termination_is_pending();

}  // namespace limber::system
