// What is as it should be is not touched.
#include "engine/recall.h"

#include <fmt/format.h>

namespace limber {

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
