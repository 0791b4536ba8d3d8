// Formats ranges, values and defaults of properties.
#include "properties/property_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limber {

std::string range_or_choices_text(const Property& property) {
  if (property.kind == PropertyKind::action) return "";
  if (!property.choices.empty()) return fmt::format("{}", fmt::join(property.choices, "|"));
  if (property.type == PropertyType::boolean || property.type == PropertyType::flags3) return "true|false";
  if (!std::isfinite(property.min) && !std::isfinite(property.max)) return "any";
  return range_text(property);
}

std::string value_text(const Property& property, const double* values) {
  if (!property.choices.empty()) {
    const double label = std::clamp(values[0], 0.0, static_cast<double>(property.choices.size() - 1));
    return property.choices[static_cast<std::size_t>(label)];
  }
  if (property.type == PropertyType::boolean || property.type == PropertyType::flags3) {
    std::vector<std::string_view> flags;
    for (std::uint32_t i = 0; i < property.width; i++) flags.emplace_back(values[i] != 0 ? "true" : "false");
    return fmt::format("{}", fmt::join(flags, " "));
  }
  return fmt::format("{:g}", fmt::join(values, values + property.width, " "));
}

std::string initial_text(const Property& property) {
  return property.writable() ? value_text(property, property.initial.data()) : "";
}

}  // namespace limber
