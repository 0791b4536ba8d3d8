// Checks the system's limits on a process: descriptors, threads, stack.
#pragma once

#include <cstddef>

#include "base/result.h"

namespace limber::system {

struct Resources {
  int descriptors = 0;    ///< Number of additional descriptors.
  int threads = 0;        ///< Number of additional threads.
  std::size_t stack = 0;  ///< Stack size of the main thread, bytes.
};

/// Checks that the system's limits allow these resources, by opening the descriptors and starting the threads briefly.
/// The error names the missing resource and the command that raises the limit. [main, before other threads start]
Result<void> check_resources(const Resources& needed);

}  // namespace limber::system
