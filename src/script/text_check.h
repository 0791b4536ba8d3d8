// What a script's text must not hold, since LuaJIT's compiler can't be stopped there, or crashes. [any]
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace limber {

struct TextFault {
  int line = 1;
  std::string what;
};

/// Nothing: the compiler may read the text. Linear in its length.
std::optional<TextFault> text_fault(std::string_view text);

}  // namespace limber
