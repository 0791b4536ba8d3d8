// What fuzz targets share: what is a fault, and desks that live on from input to input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "base/log.h"

namespace limber {

/// A fault that no sanitizer sees.
inline void must(bool condition, int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "line %d of the target does not hold\n", line);
  std::abort();
}

/// Gives the bytes to a Desk that is made for the first input, and anew when it is worn().
template <class Desk>
int live_input(const std::uint8_t* bytes, std::size_t size) {
  static std::unique_ptr<Desk>& desk = *new std::unique_ptr<Desk>;  // lives as long as the process
  if (desk == nullptr) {
    log_to_stderr(false);
    desk = std::make_unique<Desk>();
  }
  desk->input(std::string_view(reinterpret_cast<const char*>(bytes), size));
  if (desk->worn()) desk.reset();
  return 0;
}

}  // namespace limber
