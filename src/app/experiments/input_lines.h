// InputLines: the lines of the standard input of a child process. [one thread]
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "base/system/file.h"
#include "base/system/process.h"

namespace limber::app {

class InputLines {
 public:
  /// Waits for the next line and returns it without its line feed; nothing at the end of the input.
  std::optional<std::string> next() {
    while (true) {
      if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return line;
      }
      std::array<char, 1 << 14> buffer;
      const std::ptrdiff_t size = system::read_some(system::kStandardInput, buffer.data(), buffer.size());
      if (size <= 0) return {};
      text_.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }

 private:
  std::string text_;
};

}  // namespace limber::app
