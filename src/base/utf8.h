// Characters of UTF-8 text, which have one to four bytes: their length, and cuts between them.
#pragma once

#include <cstddef>
#include <string_view>

namespace limber {

/// Returns the number of bytes of the UTF-8 character at the start of `text`, which is not empty; 0 if it is invalid.
/// [any]
std::size_t utf8_length(std::string_view text);
/// True for a byte that isn't the first one of its character. [any]
inline bool continues_utf8(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

/// Returns the beginning of the text: at most `max_bytes` bytes, without a part of a character at its end. [any]
inline std::string_view utf8_prefix(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  std::size_t end = max_bytes;
  while (end > 0 && continues_utf8(text[end])) end--;
  return text.substr(0, end);
}

}  // namespace limber
