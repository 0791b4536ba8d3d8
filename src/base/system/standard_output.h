// Standard output and standard error: writes that wait for a limited time, and descriptors that were closed at the
// start.
#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>

namespace limber::system {

constexpr int kStandardOutput = 1;
constexpr int kStandardError = 2;

/// Opens a placeholder for each of the descriptors 0 to 2 that the program was started without. Otherwise the next file
/// or socket that is opened would get the number, and text would be written into it. Reading from or writing to a
/// placeholder fails with EBADF. Writing to a closed pipe fails with EPIPE, without a signal. [main, before anything is
/// opened]
void prepare_standard_descriptors();

struct Written {
  std::size_t count = 0;  ///< Bytes.
  int error = 0;          ///< The errno. EAGAIN: the descriptor took nothing within the limit. EINTR: a signal arrived.
};

/// Writes the beginning of the bytes, at most 4 KiB, as soon as the descriptor is writable. A pipe, socket or terminal
/// that is writable takes this much without waiting, unless another program fills it at the same moment. [any]
Written write_within(int fd, std::string_view bytes, std::chrono::nanoseconds limit);

/// Blocks every signal in this thread: a closed pipe, a full disk and a terminal of other programs are then errors of
/// write_within() alone. [the thread]
void block_every_signal();

/// Whether SIGINT, SIGTERM or SIGHUP is blocked (block_signals) and waits to be fetched; it stays. [any]
bool end_is_pending();

}  // namespace limber::system
