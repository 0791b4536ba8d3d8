// Stubs: POSIX has no calls for the heap size, the processor model, and suspended time.
#include "base/system/clock.h"
#include "base/system/process.h"

namespace limber::system {

bool is_portable() { return true; }

std::string processor_name() { return {}; }

double heap_bytes() { return 0; }

double suspended_seconds() { return 0; }

}  // namespace limber::system
