// Wake with an eventfd.
#include "base/system/wake.h"

#include <sys/eventfd.h>

namespace limber::system {

void open_wake(Descriptor& read_end, Descriptor& write_end) {
  read_end = Descriptor(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
  write_end = Descriptor();
}

}  // namespace limber::system
