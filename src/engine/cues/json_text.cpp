// Parses JSON without exceptions that leave it.
#include "engine/cues/json_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber::engine {

std::string line_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  return fmt::format("line {}", 1 + std::ranges::count(before, '\n'));
}

Result<nlohmann::json> parse_json_text(std::string_view text, int max_depth) {
  using Json = nlohmann::json;
  bool too_deep = false;
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > max_depth;
    return depth <= max_depth;
  };
  try {
    Json json = Json::parse(text, limit_depth);
    if (too_deep) return Error{"its values are nested too deeply"};
    return json;
  } catch (const Json::parse_error& error) {
    return Error{fmt::format("{}: not valid JSON; a comma, a quote or a bracket is missing or too much",
                             line_of(text, error.byte))};
  } catch (const Json::exception&) {
    return Error{"not valid JSON: a number is too large"};
  }
}

}  // namespace limber::engine
