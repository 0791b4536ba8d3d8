// Ranges and defaults as text.
#include "params/row_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limber {

std::string values_text(const Row& row) {
  if (row.kind == RowKind::action) return "";
  if (!row.choices.empty()) return fmt::format("{}", fmt::join(row.choices, "|"));
  if (row.type == RowType::boolean || row.type == RowType::flags3) return "true|false";
  if (!std::isfinite(row.min) && !std::isfinite(row.max)) return "any";
  return range_text(row);
}

std::string value_text(const Row& row, const double* values) {
  if (!row.choices.empty()) {
    const double label = std::clamp(values[0], 0.0, static_cast<double>(row.choices.size() - 1));
    return row.choices[static_cast<std::size_t>(label)];
  }
  if (row.type == RowType::boolean || row.type == RowType::flags3) {
    std::vector<std::string_view> truths;
    for (std::uint32_t i = 0; i < row.width; i++) truths.emplace_back(values[i] != 0 ? "true" : "false");
    return fmt::format("{}", fmt::join(truths, " "));
  }
  return fmt::format("{:g}", fmt::join(values, values + row.width, " "));
}

std::string initial_text(const Row& row) { return row.writable() ? value_text(row, row.initial.data()) : ""; }

}  // namespace limber
