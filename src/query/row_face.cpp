// Everything is derived from the row.
#include "query/row_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kLongestLabel = 60;

bool is_truth(const Row& row) { return row.type == RowType::boolean || row.type == RowType::flags3; }

std::string number_json(double value) { return std::isfinite(value) ? number_text(value) : "null"; }

// one element a number, nested as the tags are
template <class F>
std::string array_of(const Row& row, F&& element) {
  std::string text = row.type == RowType::quat ? "[[" : "[";
  for (std::size_t i = 0; i < row.width; i++) {
    if (i > 0) text += ',';
    text += element(i);
  }
  return text + (row.type == RowType::quat ? "]]" : "]");
}

std::string range_json(const Row& row, std::size_t i) {
  std::string text;
  if (std::isfinite(row.low(i))) text += fmt::format(R"("MIN":{})", number_text(row.low(i)));
  if (std::isfinite(row.high(i)))
    text += fmt::format(R"({}"MAX":{})", text.empty() ? "" : ",", number_text(row.high(i)));
  return text.empty() ? "null" : "{" + text + "}";
}

std::string labels_json(const Row& row) {
  std::string text = R"([{"VALS":[)";
  for (const std::string& label : row.choices) text += (&label == &row.choices.front() ? "" : ",") + json_text(label);
  return text + "]}]";
}

bool has_range(const Row& row) {
  for (std::size_t i = 0; i < row.width; i++) {
    if (std::isfinite(row.low(i)) || std::isfinite(row.high(i))) return true;
  }
  return false;
}

std::string clip_json(const Row& row, std::size_t i) {
  const bool low = std::isfinite(row.low(i));
  const bool high = std::isfinite(row.high(i));
  return low && high ? R"("both")" : low ? R"("low")" : high ? R"("high")" : R"("none")";
}

// colours are hue, saturation and brightness, as in the seed's messages
bool is_color(const Row& row) { return row.type == RowType::vec3 && row.unit == "hsb"; }

using Attributes = std::vector<std::pair<std::string_view, std::string>>;

Attributes make_attributes(const Row& row) {
  Attributes list;
  list.emplace_back("TYPE", json_text(tags_of(row)));
  list.emplace_back("ACCESS", std::to_string(access_of(row)));
  list.emplace_back("DESCRIPTION", json_text(short_doc(row)));
  if (row.type == RowType::choice) {
    list.emplace_back("RANGE", labels_json(row));
  } else if (!is_truth(row) && has_range(row)) {
    list.emplace_back("RANGE", array_of(row, [&](std::size_t i) { return range_json(row, i); }));
    if (row.writable()) list.emplace_back("CLIPMODE", array_of(row, [&](std::size_t i) { return clip_json(row, i); }));
  }
  if (!row.unit.empty()) list.emplace_back("UNIT", array_of(row, [&](std::size_t) { return json_text(row.unit); }));
  if (row.type == RowType::quat) list.emplace_back("EXTENDED_TYPE", R"(["quaternion"])");
  if (is_color(row)) list.emplace_back("EXTENDED_TYPE", R"(["hue","saturation","brightness"])");
  if (row.kind == RowKind::property) list.emplace_back("DEFAULT_VALUE", value_json(row, {row.initial.data(), {}}));
  if (row.step > 0) list.emplace_back("STEP_SIZE", array_of(row, [&](std::size_t) { return number_text(row.step); }));
  list.emplace_back("DOC", json_text(row.doc));
  return list;
}

struct Face {
  Attributes attributes;
  std::string text;
};

// by the row's address: tables live as long as the program. One thread at a time: each has faces of its own
const Face& face_of(const Row& row) {
  static thread_local std::unordered_map<const Row*, std::unique_ptr<const Face>> faces;
  std::unique_ptr<const Face>& face = faces[&row];
  if (face == nullptr) {
    Face made{make_attributes(row), {}};
    for (const auto& [name, json] : made.attributes) made.text += fmt::format(R"(,"{}":{})", name, json);
    face = std::make_unique<const Face>(std::move(made));
  }
  return *face;
}

}  // namespace

std::string tags_of(const Row& row) {
  switch (row.type) {
    case RowType::number:
      return "f";
    case RowType::integer:
      return row.writable() && row.max > std::numeric_limits<std::int32_t>::max() ? "h" : "i";
    case RowType::boolean:
      return "T";
    case RowType::choice:
    case RowType::text:
      return "s";
    case RowType::vec3:
      return "fff";
    case RowType::flags3:
      return "TTT";
    case RowType::quat:
      return "[ffff]";
    case RowType::none:
      break;
  }
  return row.min_args == 0 ? "N" : std::string(row.min_args, 'f');
}

int access_of(const Row& row) { return row.kind == RowKind::action ? 2 : row.writable() ? 3 : 1; }

const Attributes& attributes_of(const Row& row) { return face_of(row).attributes; }

const std::string& attributes_text(const Row& row) { return face_of(row).text; }

std::string value_json(const Row& row, const RowValue& value) {
  if (row.type == RowType::text) return "[" + json_text(value.text) + "]";
  const double* const values = value.numbers;
  if (row.type == RowType::choice) {
    const auto at = static_cast<std::size_t>(std::max(0.0, values[0]));
    return at < row.choices.size() ? "[" + json_text(row.choices[at]) + "]" : "[null]";
  }
  return array_of(row, [&](std::size_t i) -> std::string {
    if (is_truth(row)) return values[i] != 0 ? "true" : "false";
    return number_json(values[i]);
  });
}

Message value_message(const std::string& path, const Row& row, const RowValue& value) {
  Message message{path, {}};
  if (row.type == RowType::text) message.args.push_back(Arg::of(value.text));
  const double* const values = value.numbers;
  for (std::size_t i = 0; i < row.width; i++) {
    if (is_truth(row)) {
      message.args.push_back(Arg::of(values[i] != 0));
    } else if (row.type == RowType::choice) {
      const auto at = static_cast<std::size_t>(std::max(0.0, values[i]));
      message.args.push_back(Arg::of(at < row.choices.size() ? row.choices[at] : std::string()));
    } else {
      message.args.push_back(Arg::of(values[i]));
    }
  }
  return message;
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string short_doc(const Row& row) {
  const std::string clause = row.doc.substr(0, row.doc.find_first_of(".;:"));
  if (!clause.empty() && clause.size() <= kLongestLabel) return clause;
  std::string name = row.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

const std::vector<std::string_view>& known_attributes() {
  static const std::vector<std::string_view> names = {
      "FULL_PATH", "CONTENTS", "TYPE",          "ACCESS",        "VALUE",     "RANGE", "DESCRIPTION",
      "UNIT",      "CLIPMODE", "EXTENDED_TYPE", "DEFAULT_VALUE", "STEP_SIZE", "DOC"};
  return names;
}

}  // namespace limber
