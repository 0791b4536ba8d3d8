// Waits until descriptors are ready.
#pragma once

#include <chrono>
#include <optional>
#include <span>

namespace limber::system {

/// A descriptor to wait for, like pollfd.
struct PollEntry {
  int fd = -1;  ///< Ignored if negative.
  bool read = true;
  bool write = false;
  bool ready = false;  ///< Result: readable or writable as requested, or closed by the peer.
};

/// Waits until a descriptor is ready, `limit` has passed (nullopt: no limit; <= 0: don't wait), or a signal arrived.
/// False if none is ready. [any]
bool wait_ready(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit);

/// Like wait_ready(), but unblocks all signals while it waits. [any]
bool wait_ready_or_signal(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit);

}  // namespace limber::system
