// Escapes everything that could end a string or a line, or that an editor would not show.
#include "base/lua_text.h"

#include <fmt/format.h>

#include "base/utf8.h"

namespace limber {

std::string lua_string(std::string_view text) {
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = utf8_length(text.substr(i));
    const bool c1 = length == 2 && byte == 0xc2 && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    if (text[i] == '\n') {
      out += "\\n";
      i++;
    } else if (length == 0 || byte < 0x20 || byte == 0x7f || c1) {
      out += fmt::format("\\{:03}", byte);
      i++;
    } else {
      if (text[i] == '"' || text[i] == '\\') out += '\\';
      out += text.substr(i, length);
      i += length;
    }
  }
  return out + '"';
}

}  // namespace limber
