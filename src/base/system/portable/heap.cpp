// POSIX counts no heap.
#include "base/system/process.h"

namespace limber::system {

double heap_bytes() { return 0; }

}  // namespace limber::system
