// Skips a test in the builds in which it would take too long. ./check counts it neither as passed nor as failed;
// any other skipped test counts as failed.
#pragma once

#include <cstdlib>

#include <gtest/gtest.h>

#include "base/sanitized.h"

namespace limber {

/// True if .ci/arm64 runs the tests with qemu.
inline bool is_emulated() { return std::getenv("LIMBER_EMULATED") != nullptr; }

}  // namespace limber

/// Ends the test at this line if `condition` (such as kAddressSanitizer or is_emulated()) is true. The reason
/// is a string that says why that loses nothing. .ci/check_steps.sh counts the lines that begin with "left out: ".
#define LIMBER_SKIP_IF(condition, reason)                    \
  do {                                                       \
    if (condition) GTEST_SKIP() << "left out: " << (reason); \
  } while (false)
