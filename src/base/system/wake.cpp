// A flag avoids system calls for repeated notifications.
#include "base/system/wake.h"

#include <unistd.h>

#include <array>
#include <cstdint>

#include "base/check.h"

namespace limber::system {

Wake::Wake() {
  open_wake(read_end_, write_end_);
  LIMBER_CHECK(read_end_.is_open());
}

void Wake::notify() {
  if (pending_.exchange(true, std::memory_order_acq_rel)) return;
  const std::uint64_t one = 1;  // an eventfd requires eight bytes
  // Fails only if it is full, and then it is readable already.
  [[maybe_unused]] const auto written = write((write_end_.is_open() ? write_end_ : read_end_).fd(), &one, sizeof one);
}

void Wake::clear() {
  std::array<std::uint64_t, 8> bytes{};
  [[maybe_unused]] const auto got = read(read_end_.fd(), bytes.data(), sizeof bytes);
  // A notification between the read and here writes nothing; the caller sees its cause, which it checks afterwards.
  pending_.exchange(false, std::memory_order_acq_rel);
}

}  // namespace limber::system
