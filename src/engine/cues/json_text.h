// Parses the JSON of files that people edit by hand. [any]
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"

namespace limber::engine {

/// Parses JSON with at most `max_depth` nested values. The error names the line.
Result<nlohmann::json> parse_json_text(std::string_view text, int max_depth);

/// Returns "line 3": the line of a byte.
std::string line_of(std::string_view text, std::size_t byte);

}  // namespace limber::engine
