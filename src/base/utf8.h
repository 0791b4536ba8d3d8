// Validates UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace limber {

/// Returns the number of bytes of the UTF-8 character at the start of `text`, which is not empty; 0 if it is invalid.
std::size_t utf8_length(std::string_view text);

}  // namespace limber
