// Limits of the system on a program: descriptors, threads, stack.
#pragma once

#include <cstddef>

#include "base/result.h"

namespace limber::system {

struct Resources {
  int descriptors = 0;    ///< That can be opened beside those that are open.
  int threads = 0;        ///< That can be started beside this one.
  std::size_t stack = 0;  ///< Of the first thread, bytes.
};

/// Checks that the system's limits leave room for these resources: opens the descriptors and starts the threads for a
/// moment. The error names what is missing and the command that raises the limit. [main, before other threads start]
Result<void> check_resources(const Resources& needed);

}  // namespace limber::system
