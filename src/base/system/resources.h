// What the system gives a program at most: descriptors, threads, stack.
#pragma once

#include <cstddef>

#include "base/result.h"

namespace limber::system {

struct Resources {
  int descriptors = 0;    ///< That can be opened beside those that are open.
  int threads = 0;        ///< That can be started beside this one.
  std::size_t stack = 0;  ///< Of the first thread, bytes.
};

/// Tries whether a program that needs so much can run: opens so many descriptors and starts so many threads, for a
/// moment. The error names what is missing and the command that raises it. [main, before other threads are started]
Result<void> check_resources(const Resources& needed);

}  // namespace limber::system
