// Formatting of presets.
#include "engine/presets/text.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber {

namespace {

std::string json_quoted(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string value_text(const PresetProperty& property, const double* values) {
  if (property.type == PropertyType::choice) return json_quoted(property.labels[static_cast<std::size_t>(values[0])]);
  const bool flags = property.type == PropertyType::boolean || property.type == PropertyType::flags3;
  const auto one = [&](double v) {
    if (flags) return std::string(v != 0 ? "true" : "false");
    return v == 0 && std::signbit(v) ? "-0.0" : fmt::format("{}", v);  // "-0" would be read back as the integer 0
  };
  const bool list = property.type != PropertyType::boolean && property.type != PropertyType::number;
  if (!list) return one(values[0]);
  std::string text = "[";
  for (std::uint32_t i = 0; i < property.width; i++) text += (i == 0 ? "" : ", ") + one(values[i]);
  return text + "]";
}

void add_patterns(std::string& out, const char* key, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return;
  std::string list;
  for (const std::string& pattern : patterns) list += (list.empty() ? "" : ", ") + json_quoted(pattern);
  out += fmt::format(",\n      \"{}\": [{}]", key, list);
}

void add_preset(std::string& out, const Preset& preset) {
  out += fmt::format("    {{\n      \"name\": {}", json_quoted(preset.name));
  add_patterns(out, "rows", preset.selection.include);
  add_patterns(out, "except", preset.selection.except);
  if (preset.selection.poses) out += ",\n      \"poses\": true";
  if (preset.selection.velocities) out += ",\n      \"velocities\": true";
  out += ",\n      \"values\": {";
  const PresetSchema& schema = *preset.schema;
  const char* comma = "";
  for (std::uint32_t i = 0; i < schema.nodes().size(); i++) {
    const PresetSchema::Node& node = schema.nodes()[i];
    const PresetLayout* const layout = schema.layout(node);
    if (layout == nullptr) continue;
    out += fmt::format("{}\n        {}: {{", comma, json_quoted(schema.path(i)));
    for (std::size_t k = 0; k < layout->properties.size(); k++) {
      out += fmt::format("{}\n          {}: {}", k == 0 ? "" : ",", json_quoted(layout->properties[k].name),
                         value_text(layout->properties[k], preset.values.data() + node.offset + layout->offsets[k]));
    }
    out += "\n        }";
    comma = ",";
  }
  out += "\n      }\n    }";
}

}  // namespace

std::string text_of(const PresetList& presets) {
  std::string out = fmt::format("{{\n  \"{}\": {},\n  \"presets\": [", kPresetVersionKey, kPresetVersion);
  for (const auto& preset : presets) {
    out += preset == presets.front() ? "\n" : ",\n";
    add_preset(out, *preset);
  }
  return out + (presets.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace limber
