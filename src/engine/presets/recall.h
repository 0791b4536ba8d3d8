// Recall: applies a preset, or a blend of two, to the live world through the property setters. [sim]
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/presets/binding.h"
#include "engine/presets/preset.h"
#include "properties/interpolate.h"

namespace limber {

/// Calls f(node, property, values) for each value of the blend that applies to the world, in the order of the binding.
template <class F>
void for_each_value(const PresetBinding& binding, const Blend& blend, F&& f) {
  std::array<double, 4> a{};
  std::array<double, 4> b{};
  for (const PresetBinding::Node& node : binding.nodes()) {
    for (const PresetBinding::BoundProperty& bound : binding.layout(node).properties) {
      if ((node.excluded >> bound.property->index & 1u) != 0) continue;
      if (!PresetBinding::read(bound, blend.a->values.data() + node.offset, a.data())) continue;
      if (blend.amount > 0) {
        if (!PresetBinding::read(bound, blend.b->values.data() + node.offset, b.data())) continue;
        mix(*bound.property, a.data(), b.data(), blend.amount, a.data());
      }
      f(node, *bound.property, a.data());
    }
  }
}

// Compares bit by bit. Inline: for up to four values a call would cost more than the comparison.
inline bool same_bits(const double* a, const double* b, std::size_t count) {
  for (std::size_t i = 0; i < count; i++) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

/// Values that could not be applied unchanged.
struct RecallResult {
  std::size_t clamped = 0;  ///< Outside the current range of the property.
  std::size_t rejected = 0;
  std::string first_problem;  ///< Path of the first one of both, with the reason.
};

/// Describes values that stay unchanged because their property has lost that choice; empty if there are none.
std::string missing_choices(const Store& store, const PresetBinding& binding, const Blend& blend);

/// Applies the blend at once. Values that are equal already are not written, so that they cause no on-change callbacks.
RecallResult recall(Store& store, const PresetBinding& binding, const Blend& blend);

}  // namespace limber
