// Cells of CSV (RFC 4180).
#pragma once

#include <string>
#include <string_view>

namespace limber {

/// Returns the text as a cell: in quotation marks if it contains a comma, a quotation mark or a line break.
inline std::string csv_cell(std::string_view text) {
  if (text.find_first_of("\",\n\r") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  return out + "\"";
}

}  // namespace limber
