// Ranges and defaults as text.
#include "params/row_text.h"

#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace limber {

std::string values_text(const Row& row) {
  if (row.kind == RowKind::action) return "";
  if (!row.choices.empty()) return fmt::format("{}", fmt::join(row.choices, "|"));
  if (row.type == RowType::boolean || row.type == RowType::flags3) return "true|false";
  if (!std::isfinite(row.min) && !std::isfinite(row.max)) return "any";
  return range_text(row);
}

std::string initial_text(const Row& row) {
  if (!row.writable()) return "";
  if (!row.choices.empty()) return row.choices[static_cast<std::size_t>(row.initial[0])];
  if (row.type == RowType::boolean || row.type == RowType::flags3) {
    std::vector<std::string_view> truths;
    for (std::uint32_t i = 0; i < row.width; i++) truths.emplace_back(row.initial[i] != 0 ? "true" : "false");
    return fmt::format("{}", fmt::join(truths, " "));
  }
  return fmt::format("{:g}", fmt::join(row.initial.begin(), row.initial.begin() + row.width, " "));
}

}  // namespace limber
