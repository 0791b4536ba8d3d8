// The wall clock that measures how long things take. Nothing that it says enters a run. [any]
#pragma once

#include <chrono>

namespace limber {

inline double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace limber
