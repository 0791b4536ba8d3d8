// Closes file descriptors.
#include "base/system/descriptor.h"

#include <unistd.h>

namespace limber::system {

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace limber::system
