// Conversion between values of parameters and presets, and their file.
#include "app/experiments/parameter_presets.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/presets/file.h"

namespace limber::app {

namespace {

using experiments::Axis;

constexpr const char* kNode = "/scene";  // the node of the parameters

std::string free_name(const engine::PresetList& list, const std::string& name) {
  for (int n = 1;; n++) {
    std::string numbered = fmt::format("{}_{}", name, n);
    const bool used = std::ranges::any_of(list, [&](const auto& preset) { return preset->name == numbered; });
    if (!used) return numbered;
  }
}

// Converts a value of a preset; nothing if it isn't one of the axis. A choice corresponds by its word: presets that
// were read from a file number their words differently.
std::optional<double> value_on(const Axis& axis, const engine::PresetProperty& property, double value) {
  const bool choice = property.type == PropertyType::choice;
  if (choice != !axis.choices.empty() || property.width != 1) return {};
  if (!choice) return value;
  const auto word = std::ranges::find(axis.choices, property.labels[static_cast<std::size_t>(value)]);
  if (word == axis.choices.end()) return {};
  return static_cast<double>(word - axis.choices.begin());
}

}  // namespace

std::shared_ptr<const engine::Preset> parameter_preset(const std::vector<Axis>& axes, const std::vector<double>& values,
                                                       const std::string& name,
                                                       const std::shared_ptr<const engine::PresetSchema>& shared) {
  engine::PresetLayout layout;
  engine::PresetSelection selection;
  for (const Axis& axis : axes) {
    const PropertyType type = !axis.choices.empty() ? PropertyType::choice
                              : axis.boolean        ? PropertyType::boolean
                                                    : PropertyType::number;
    layout.add({axis.name, type, 1, axis.choices});
    selection.include.push_back(fmt::format("{}/{}", kNode, axis.name));
  }
  engine::PresetBuilder builder;
  (void)builder.add(kNode, std::move(layout), values);
  return builder.finish(name, std::move(selection), shared);
}

std::vector<double> parameter_values(const engine::Preset& preset, const std::vector<Axis>& axes,
                                     const std::vector<double>& otherwise) {
  std::vector<double> values = otherwise;
  const engine::PresetSchema& schema = *preset.schema;
  for (std::uint32_t node = 0; node < schema.nodes().size(); node++) {
    const engine::PresetSchema::Node& entry = schema.nodes()[node];
    const engine::PresetLayout* const layout = schema.layout(entry);
    if (layout == nullptr || schema.path(node) != kNode) continue;
    for (std::size_t i = 0; i < axes.size(); i++) {
      const int index = layout->find(axes[i].name);
      if (index < 0) continue;
      const auto at = static_cast<std::size_t>(index);
      const double value = preset.values[entry.offset + layout->offsets[at]];
      values[i] = value_on(axes[i], layout->properties[at], value).value_or(values[i]);
    }
  }
  return values;
}

Result<engine::PresetList> PresetStore::read() const {
  Result<engine::ParsedPresets> parsed = engine::PresetFile(file).load();
  if (!parsed) return Error{parsed.error()};
  return std::move(parsed->presets);
}

Result<std::vector<std::string>> PresetStore::add(const std::vector<Axis>& axes,
                                                  const std::vector<std::vector<double>>& values,
                                                  const std::string& name, std::string& notice) const {
  if (const std::optional<std::string> fault = name_error(name))
    return Error{fmt::format("'{}' can't be the name of presets: {}", printable(shortened(name, 40)), *fault)};
  engine::PresetFile presets(file, engine::PresetFile::write_access_for(file, locks, true));
  Result<engine::ParsedPresets> before = presets.load();  // a file that can't be read is backed up
  engine::PresetList list = before ? std::move(before->presets) : engine::PresetList();
  std::vector<std::string> names;
  for (const std::vector<double>& each : values) {
    names.push_back(free_name(list, name));
    list.push_back(parameter_preset(axes, each, names.back(), nullptr));
  }
  if (const Result<void> saved = presets.save(list, notice); !saved)
    return Error{fmt::format("{}: {}; choose another file with --presets", printable(file), saved.error())};
  return names;
}

}  // namespace limber::app
