// Shared by the fuzz targets: an assertion, and a fixture that persists across inputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "base/log/log.h"

namespace limber {

/// Assertion for faults that no sanitizer detects: aborts if `condition` is false.
inline void must(bool condition, int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "line %d of the target: assertion failed\n", line);
  std::abort();
}

/// Passes the bytes to a fixture that persists across inputs until it asks for its renewal; the next input then gets a
/// new one.
template <class Fixture>
int persistent_input(const std::uint8_t* bytes, std::size_t size) {
  static std::unique_ptr<Fixture>& fixture = *new std::unique_ptr<Fixture>;  // never destroyed
  if (fixture == nullptr) {
    log_to_stderr(false);
    fixture = std::make_unique<Fixture>();
  }
  fixture->input(std::string_view(reinterpret_cast<const char*>(bytes), size));
  if (fixture->needs_renewal()) fixture.reset();
  return 0;
}

}  // namespace limber
