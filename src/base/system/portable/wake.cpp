// Wake with a pipe.
#include "base/system/wake.h"

#include "base/system/open.h"

namespace limber::system {

void open_wake(Descriptor& read_end, Descriptor& write_end) {
  if (!open_pipe(read_end, write_end)) return;
  set_nonblocking(read_end.fd());
  set_nonblocking(write_end.fd());
}

}  // namespace limber::system
