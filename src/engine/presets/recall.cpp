// Applying a blend, and reporting values that could not be applied.
#include "engine/presets/recall.h"

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

// Returns the label of the preset's value if the property has no such choice, else null.
const std::string* missing_label(const PresetBinding::BoundProperty& property, const double* values) {
  const auto label = static_cast<std::size_t>(values[property.offset]);
  return property.choice_map[label] < 0 ? &property.source->labels[label] : nullptr;
}

}  // namespace

std::string missing_choices(const Store& store, const PresetBinding& binding, const Blend& blend) {
  std::size_t count = 0;
  std::string first;
  for (const PresetBinding::Node& node : binding.nodes()) {
    for (const std::uint32_t i : binding.layout(node).incomplete_choices) {
      const PresetBinding::BoundProperty& property = binding.layout(node).properties[i];
      if ((node.excluded >> property.property->index & 1u) != 0) continue;
      const std::string* label = missing_label(property, blend.a->values.data() + node.offset);
      if (label == nullptr && blend.amount > 0) label = missing_label(property, blend.b->values.data() + node.offset);
      if (label == nullptr || count++ > 0) continue;
      first = fmt::format("{}/{} has no '{}' any more", store.path(node.id), property.property->name,
                          printable(shortened(*label, 100)));
    }
  }
  if (count == 0) return {};
  return fmt::format("{} choice{} {} ({})", count, count == 1 ? "" : "s",
                     count == 1 ? "stays unchanged" : "stay unchanged", first);
}

RecallResult recall(Store& store, const PresetBinding& binding, const Blend& blend) {
  RecallResult result;
  for_each_value(binding, blend, [&](const PresetBinding::Node& node, const Property& property, const double* values) {
    if (same_bits(values, store.values(node.id, property), property.width)) return;
    const Result<SetOutcome> set = store.set(node.id, property, {values, property.width});
    if (set && !set->clamped) return;
    if (result.clamped + result.rejected == 0) {
      result.first_problem =
          set ? fmt::format("{}/{} accepts {}", store.path(node.id), property.name, range_text(property)) : set.error();
    }
    (set ? result.clamped : result.rejected)++;
  });
  return result;
}

}  // namespace limber
