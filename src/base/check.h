// LIMBER_CHECK: assertion for programming errors. A failure fails a test (through the hook); the program logs it once
// per location and continues.
#pragma once

#include <atomic>

namespace limber {

/// Sets the function that is called for each failed check (null: log it). Tests set one that fails the test. [any]
using CheckHook = void (*)(const char* condition, const char* file, int line);
void set_check_hook(CheckHook hook);

namespace detail {
void check_failed(const char* condition, const char* file, int line, std::atomic<bool>& reported);
}

}  // namespace limber

#define LIMBER_CHECK(condition)                                                 \
  do {                                                                          \
    if (!(condition)) {                                                         \
      static std::atomic<bool> reported{false};                                 \
      ::limber::detail::check_failed(#condition, __FILE__, __LINE__, reported); \
    }                                                                           \
  } while (false)
