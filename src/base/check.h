// CHECK: for our own mistakes. Tests fail on one (through the hook); the program logs once per place and carries on.
#pragma once

#include <atomic>

namespace limber {

/// Called for each failed CHECK. Tests set one that fails the test; without one the failure is logged. [any]
using CheckHook = void (*)(const char* condition, const char* file, int line);
void set_check_hook(CheckHook hook);

namespace detail {
void check_failed(const char* condition, const char* file, int line, std::atomic<bool>& said);
}

}  // namespace limber

#define LIMBER_CHECK(condition)                                             \
  do {                                                                      \
    if (!(condition)) {                                                     \
      static std::atomic<bool> said{false};                                 \
      ::limber::detail::check_failed(#condition, __FILE__, __LINE__, said); \
    }                                                                       \
  } while (false)
