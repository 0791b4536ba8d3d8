// Wake: an eventfd that any thread rings and one thread polls. Rings before the answer cost one atomic each.
#pragma once

#include <atomic>

#include "base/descriptor.h"

namespace limber {

class Wake {
 public:
  Wake();

  /// [any]
  void ring();
  /// After this, everything that was done before any earlier ring() is seen. [the polling thread]
  void answer();
  int fd() const { return event_.fd(); }

 private:
  Descriptor event_;
  std::atomic<bool> rung_{false};
};

}  // namespace limber
