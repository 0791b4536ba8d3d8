// Wake: wakes one thread, which waits for a descriptor to be readable, from any thread. Repeated notifications before
// the next clear() cost one atomic operation each.
#pragma once

#include <atomic>

#include "base/system/descriptor.h"

namespace limber::system {

class Wake {
 public:
  Wake();

  /// Makes the descriptor readable. [any]
  void notify();
  /// Resets the descriptor. Memory writes before earlier notify() calls are visible after it. [the waiting thread]
  void clear();
  int fd() const { return read_end_.fd(); }

 private:
  Descriptor read_end_;
  Descriptor write_end_;  // closed if one descriptor serves both ends
  std::atomic<bool> pending_{false};
};

/// Opens both ends, non-blocking. `write_end` stays closed if one descriptor serves both.
void open_wake(Descriptor& read_end, Descriptor& write_end);

}  // namespace limber::system
