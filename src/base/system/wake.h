// Wake: any thread notifies it, one thread waits until its descriptor is readable. Notifications before the next
// clear() cost one atomic each.
#pragma once

#include <atomic>

#include "base/system/descriptor.h"

namespace limber::system {

class Wake {
 public:
  Wake();

  /// [any]
  void notify();
  /// After this, everything that was done before any earlier notify() is visible. [the waiting thread]
  void clear();
  int fd() const { return read_end_.fd(); }

 private:
  Descriptor read_end_;
  Descriptor write_end_;  // closed where one descriptor has both ends
  std::atomic<bool> pending_{false};
};

/// Opens the two ends, not blocking; the second one stays closed where one descriptor has both ends.
void open_wake(Descriptor& read_end, Descriptor& write_end);

}  // namespace limber::system
