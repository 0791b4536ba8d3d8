// Parses hexadecimal digits, the text form of the OSC types r, m, t and b.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace limber {

/// Returns 0 .. 15, or -1 if `c` is no hexadecimal digit.
constexpr int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Returns the lowest 64 bits of the number up to the first non-digit.
constexpr std::uint64_t hex_number(std::string_view digits) {
  std::uint64_t number = 0;
  for (const char c : digits) {
    if (hex_digit(c) < 0) break;
    number = number << 4 | static_cast<std::uint64_t>(hex_digit(c));
  }
  return number;
}

/// Converts pairs of digits to bytes, up to the first pair that is not two digits.
inline std::string hex_bytes(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size() && hex_digit(digits[i]) >= 0 && hex_digit(digits[i + 1]) >= 0; i += 2) {
    bytes += static_cast<char>(hex_digit(digits[i]) * 16 + hex_digit(digits[i + 1]));
  }
  return bytes;
}

}  // namespace limber
