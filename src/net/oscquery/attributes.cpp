// Derives all attributes from the property's description.
#include "net/oscquery/attributes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber::oscquery {

namespace {

constexpr std::size_t kMaxLabel = 60;

bool is_boolean(const Property& property) {
  return property.type == PropertyType::boolean || property.type == PropertyType::flags3;
}

std::string number_json(double value) { return std::isfinite(value) ? number_text(value) : "null"; }

// Returns a JSON array with one element per number, nested like the type tags.
template <class F>
std::string array_of(const Property& property, F&& element) {
  std::string text = property.type == PropertyType::quat ? "[[" : "[";
  for (std::size_t i = 0; i < property.width; i++) {
    if (i > 0) text += ',';
    text += element(i);
  }
  return text + (property.type == PropertyType::quat ? "]]" : "]");
}

std::string range_json(const Property& property, std::size_t i) {
  std::string text;
  if (std::isfinite(property.low(i))) text += fmt::format(R"("MIN":{})", number_text(property.low(i)));
  if (std::isfinite(property.high(i)))
    text += fmt::format(R"({}"MAX":{})", text.empty() ? "" : ",", number_text(property.high(i)));
  return text.empty() ? "null" : "{" + text + "}";
}

std::string labels_json(const Property& property) {
  std::string text = R"([{"VALS":[)";
  for (const std::string& label : property.choices)
    text += (&label == &property.choices.front() ? "" : ",") + json_text(label);
  return text + "]}]";
}

bool has_range(const Property& property) {
  for (std::size_t i = 0; i < property.width; i++) {
    if (std::isfinite(property.low(i)) || std::isfinite(property.high(i))) return true;
  }
  return false;
}

std::string clip_json(const Property& property, std::size_t i) {
  const bool low = std::isfinite(property.low(i));
  const bool high = std::isfinite(property.high(i));
  return low && high ? R"("both")" : low ? R"("low")" : high ? R"("high")" : R"("none")";
}

// Colors are hue, saturation and brightness, as in ofxDabPhysics messages.
bool is_color(const Property& property) { return property.type == PropertyType::vec3 && property.unit == "hsb"; }

using Attributes = std::vector<std::pair<std::string_view, std::string>>;

Attributes make_attributes(const Property& property) {
  Attributes list;
  list.emplace_back("TYPE", json_text(tags_of(property)));
  list.emplace_back("ACCESS", std::to_string(access_of(property)));
  list.emplace_back("DESCRIPTION", json_text(short_doc(property)));
  if (property.type == PropertyType::choice) {
    list.emplace_back("RANGE", labels_json(property));
  } else if (!is_boolean(property) && has_range(property)) {
    list.emplace_back("RANGE", array_of(property, [&](std::size_t i) { return range_json(property, i); }));
    if (property.writable())
      list.emplace_back("CLIPMODE", array_of(property, [&](std::size_t i) { return clip_json(property, i); }));
  }
  if (!property.unit.empty())
    list.emplace_back("UNIT", array_of(property, [&](std::size_t) { return json_text(property.unit); }));
  if (property.type == PropertyType::quat) list.emplace_back("EXTENDED_TYPE", R"(["quaternion"])");
  if (is_color(property)) list.emplace_back("EXTENDED_TYPE", R"(["hue","saturation","brightness"])");
  if (property.kind == PropertyKind::setting)
    list.emplace_back("DEFAULT_VALUE", value_json(property, {property.initial.data(), {}}));
  if (property.step > 0)
    list.emplace_back("STEP_SIZE", array_of(property, [&](std::size_t) { return number_text(property.step); }));
  list.emplace_back("DOC", json_text(property.doc));
  return list;
}

struct AttributeCache {
  Attributes attributes;
  std::string text;
};

// Cached by the property's address, because property tables live as long as the program. Each thread has its own cache,
// so no lock is needed.
const AttributeCache& attributes_cached(const Property& property) {
  static thread_local std::unordered_map<const Property*, std::unique_ptr<const AttributeCache>> caches;
  std::unique_ptr<const AttributeCache>& cache = caches[&property];
  if (cache == nullptr) {
    AttributeCache new_cache{make_attributes(property), {}};
    for (const auto& [name, json] : new_cache.attributes) new_cache.text += fmt::format(R"(,"{}":{})", name, json);
    cache = std::make_unique<const AttributeCache>(std::move(new_cache));
  }
  return *cache;
}

}  // namespace

std::string tags_of(const Property& property) {
  switch (property.type) {
    case PropertyType::number:
      return "f";
    case PropertyType::integer:
      return property.writable() && property.max > std::numeric_limits<std::int32_t>::max() ? "h" : "i";
    case PropertyType::boolean:
      return "T";
    case PropertyType::choice:
    case PropertyType::text:
      return "s";
    case PropertyType::vec3:
      return "fff";
    case PropertyType::flags3:
      return "TTT";
    case PropertyType::quat:
      return "[ffff]";
    case PropertyType::none:
      break;
  }
  return property.min_args == 0 ? "N" : std::string(property.min_args, 'f');
}

int access_of(const Property& property) {
  return property.kind == PropertyKind::action ? 2 : property.writable() ? 3 : 1;
}

const Attributes& attributes_of(const Property& property) { return attributes_cached(property).attributes; }

const std::string& attributes_text(const Property& property) { return attributes_cached(property).text; }

std::string value_json(const Property& property, const engine::PropertyValue& value) {
  if (property.type == PropertyType::text) return "[" + json_text(value.text) + "]";
  const double* const values = value.numbers;
  if (property.type == PropertyType::choice) {
    const auto at = static_cast<std::size_t>(std::max(0.0, values[0]));
    return at < property.choices.size() ? "[" + json_text(property.choices[at]) + "]" : "[null]";
  }
  return array_of(property, [&](std::size_t i) -> std::string {
    if (is_boolean(property)) return values[i] != 0 ? "true" : "false";
    return number_json(values[i]);
  });
}

Message value_message(const std::string& path, const Property& property, const engine::PropertyValue& value) {
  Message message{path, {}};
  if (property.type == PropertyType::text) message.args.push_back(Arg::of(value.text));
  const double* const values = value.numbers;
  for (std::size_t i = 0; i < property.width; i++) {
    if (is_boolean(property)) {
      message.args.push_back(Arg::of(values[i] != 0));
    } else if (property.type == PropertyType::choice) {
      const auto at = static_cast<std::size_t>(std::max(0.0, values[i]));
      message.args.push_back(Arg::of(at < property.choices.size() ? property.choices[at] : std::string()));
    } else {
      message.args.push_back(Arg::of(values[i]));
    }
  }
  return message;
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string short_doc(const Property& property) {
  const std::string clause = property.doc.substr(0, property.doc.find_first_of(".;:"));
  if (!clause.empty() && clause.size() <= kMaxLabel) return clause;
  std::string name = property.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

const std::vector<std::string_view>& known_attributes() {
  static const std::vector<std::string_view> names = {
      "FULL_PATH", "CONTENTS", "TYPE",          "ACCESS",        "VALUE",     "RANGE", "DESCRIPTION",
      "UNIT",      "CLIPMODE", "EXTENDED_TYPE", "DEFAULT_VALUE", "STEP_SIZE", "DOC"};
  return names;
}

}  // namespace limber::oscquery
