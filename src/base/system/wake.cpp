// A flag keeps the number of system calls small.
#include "base/system/wake.h"

#include <unistd.h>

#include <array>
#include <cstdint>

#include "base/check.h"

namespace limber::system {

Wake::Wake() {
  open_wake(read_end_, write_end_);
  LIMBER_CHECK(read_end_.open());
}

void Wake::notify() {
  if (pending_.exchange(true, std::memory_order_acq_rel)) return;
  const std::uint64_t one = 1;  // an eventfd takes eight bytes
  // fails only when it is full, and then it is readable already
  [[maybe_unused]] const auto written = write((write_end_.open() ? write_end_ : read_end_).fd(), &one, sizeof one);
}

void Wake::clear() {
  std::array<std::uint64_t, 8> bytes{};
  [[maybe_unused]] const auto got = read(read_end_.fd(), bytes.data(), sizeof bytes);
  // a notification between the read and here writes nothing; the caller sees its cause, since it looks after this
  pending_.exchange(false, std::memory_order_acq_rel);
}

}  // namespace limber::system
