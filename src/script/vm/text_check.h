// Rejects script texts that LuaJIT's compiler can't process: it would crash, or could not be stopped. [any]
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace limber::script {

struct TextFault {
  int line = 1;
  std::string message;
};

/// Returns the fault, or nothing if the text is acceptable. Linear time.
std::optional<TextFault> text_fault(std::string_view text);

}  // namespace limber::script
