// Waiting until descriptors are ready.
#pragma once

#include <chrono>
#include <optional>
#include <span>

namespace limber::system {

struct Waiting {
  int fd = -1;  ///< Negative: left out.
  bool read = true;
  bool write = false;
  bool ready = false;  ///< Set: it can be read or written, as asked for, or its other end has closed.
};

/// Waits until one of them is ready, `limit` is over (nothing: without limit), or a signal has come; 0 and below none
/// waits. False: none is ready. [any]
bool wait_ready(std::span<Waiting> list, std::optional<std::chrono::nanoseconds> limit);

/// The same; signals that are blocked otherwise come in while it waits, and only then. [any]
bool wait_ready_or_signal(std::span<Waiting> list, std::optional<std::chrono::nanoseconds> limit);

}  // namespace limber::system
