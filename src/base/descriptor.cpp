// Closing.
#include "base/descriptor.h"

#include <unistd.h>

namespace limber {

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace limber
