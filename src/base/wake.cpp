// An eventfd closes like a socket.
#include "base/wake.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

#include "base/check.h"

namespace limber {

Wake::Wake() : event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) { LIMBER_CHECK(event_.open()); }

void Wake::ring() {
  if (rung_.exchange(true, std::memory_order_acq_rel)) return;
  const std::uint64_t one = 1;
  // it can fail only when the counter is full, and then it is rung already
  [[maybe_unused]] const auto written = write(event_.fd(), &one, sizeof one);
}

void Wake::answer() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = read(event_.fd(), &count, sizeof count);
  // a ring between the read and here writes nothing; what it announces is seen by who drains after this
  rung_.exchange(false, std::memory_order_acq_rel);
}

}  // namespace limber
