// Written line by line.
#include "engine/preset_text.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber {

namespace {

std::string json_quoted(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string value_text(const PresetRow& row, const double* values) {
  if (row.type == RowType::choice) return json_quoted(row.labels[static_cast<std::size_t>(values[0])]);
  const bool truths = row.type == RowType::boolean || row.type == RowType::flags3;
  const auto one = [&](double v) {
    if (truths) return std::string(v != 0 ? "true" : "false");
    return v == 0 && std::signbit(v) ? "-0.0" : fmt::format("{}", v);  // without a point it would be a whole 0
  };
  const bool list = row.type != RowType::boolean && row.type != RowType::number;
  if (!list) return one(values[0]);
  std::string text = "[";
  for (std::uint32_t i = 0; i < row.width; i++) text += (i == 0 ? "" : ", ") + one(values[i]);
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
  add_patterns(out, "rows", preset.choice.rows);
  add_patterns(out, "except", preset.choice.except);
  if (preset.choice.poses) out += ",\n      \"poses\": true";
  if (preset.choice.velocities) out += ",\n      \"velocities\": true";
  out += ",\n      \"values\": {";
  const PresetShape& shape = *preset.shape;
  const char* comma = "";
  for (std::uint32_t i = 0; i < shape.things().size(); i++) {
    const PresetShape::Thing& thing = shape.things()[i];
    const PresetClass* const rows = shape.rows(thing);
    if (rows == nullptr) continue;
    out += fmt::format("{}\n        {}: {{", comma, json_quoted(shape.path(i)));
    for (std::size_t k = 0; k < rows->rows.size(); k++) {
      out += fmt::format("{}\n          {}: {}", k == 0 ? "" : ",", json_quoted(rows->rows[k].name),
                         value_text(rows->rows[k], preset.values.data() + thing.at + rows->offsets[k]));
    }
    out += "\n        }";
    comma = ",";
  }
  out += "\n      }\n    }";
}

}  // namespace

std::string text_of(const PresetList& presets) {
  std::string out = fmt::format("{{\n  \"{}\": {},\n  \"presets\": [", kPresetHead, kPresetVersion);
  for (const auto& preset : presets) {
    out += preset == presets.front() ? "\n" : ",\n";
    add_preset(out, *preset);
  }
  return out + (presets.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace limber
