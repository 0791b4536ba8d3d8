// What is as it should be is not touched.
#include "engine/recall.h"

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

// the label that the row does not have, or null
const std::string* lost_label(const PresetBinding::FitRow& row, const double* values) {
  const auto label = static_cast<std::size_t>(values[row.at]);
  return row.choices[label] < 0 ? &row.from->labels[label] : nullptr;
}

}  // namespace

std::string lost_choices(const Store& store, const PresetBinding& binding, const Blend& blend) {
  std::size_t count = 0;
  std::string first;
  for (const PresetBinding::Thing& thing : binding.things()) {
    for (const std::uint32_t i : binding.fit(thing).poorer) {
      const PresetBinding::FitRow& row = binding.fit(thing).rows[i];
      if ((thing.left_alone >> row.row->index & 1u) != 0) continue;
      const std::string* label = lost_label(row, blend.a->values.data() + thing.at);
      if (label == nullptr && blend.amount > 0) label = lost_label(row, blend.b->values.data() + thing.at);
      if (label == nullptr || count++ > 0) continue;
      first = fmt::format("{}/{} has no '{}' any more", store.path(thing.id), row.row->name,
                          printable(shortened(*label, 100)));
    }
  }
  if (count == 0) return {};
  return fmt::format("{} choice{} {} ({})", count, count == 1 ? "" : "s",
                     count == 1 ? "stays as it is" : "stay as they are", first);
}

Recalled recall(Store& store, const PresetBinding& binding, const Blend& blend) {
  Recalled told;
  each_value(binding, blend, [&](const PresetBinding::Thing& thing, const Row& row, const double* values) {
    if (same_bits(values, store.values(thing.id, row), row.width)) return;
    const Result<SetOutcome> set = store.set(thing.id, row, {values, row.width});
    if (set && !set->clamped) return;
    if (told.clamped + told.refused == 0) {
      told.first = set ? fmt::format("{}/{} takes {}", store.path(thing.id), row.name, range_text(row)) : set.error();
    }
    (set ? told.clamped : told.refused)++;
  });
  return told;
}

}  // namespace limber
