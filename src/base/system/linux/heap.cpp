// glibc counts its heap.
#include <malloc.h>

#include "base/system/process.h"

namespace limber::system {

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

}  // namespace limber::system
