// Checks of option values. Unlike CLI11's own, their messages are the same in all versions of CLI11.
#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/text.h"

namespace limber::app {

/// A number within these limits. Help shows "from 0.5 to 4".
inline CLI::Validator between(double min, double max) {
  const std::string range = fmt::format("from {} to {}", number_text(min), number_text(max));
  return CLI::Validator(
      [=](std::string& text) {
        const std::optional<double> number = parse_number(text);
        return number && *number >= min && *number <= max ? std::string()
                                                          : fmt::format("'{}' must be a number {}", text, range);
      },
      range, "range");
}

}  // namespace limber::app
