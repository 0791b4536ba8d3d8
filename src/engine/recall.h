// Recall: a preset, or what lies between two, goes through the door into the live world. [sim]
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/preset.h"
#include "engine/preset_binding.h"
#include "params/mix.h"

namespace limber {

/// Calls f(thing, row, numbers) for each value of the blend that the world takes, in the binding's order.
template <class F>
void each_value(const PresetBinding& binding, const Blend& blend, F&& f) {
  std::array<double, 4> a{};
  std::array<double, 4> b{};
  for (const PresetBinding::Thing& thing : binding.things()) {
    for (const PresetBinding::FitRow& fit : binding.fit(thing).rows) {
      if ((thing.left_alone >> fit.row->index & 1u) != 0) continue;
      if (!PresetBinding::read(fit, blend.a->values.data() + thing.at, a.data())) continue;
      if (blend.amount > 0) {
        if (!PresetBinding::read(fit, blend.b->values.data() + thing.at, b.data())) continue;
        mix(*fit.row, a.data(), b.data(), blend.amount, a.data());
      }
      f(thing, *fit.row, a.data());
    }
  }
}

// of so few numbers that a call would cost more
inline bool same_bits(const double* a, const double* b, std::size_t count) {
  for (std::size_t i = 0; i < count; i++) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

/// What was not taken as it is.
struct Recalled {
  std::size_t clamped = 0;  ///< Outside their ranges as they are now.
  std::size_t refused = 0;
  std::string first;  ///< The first of both, and why.
};

/// What stays as it is because its row has no such choice any more; empty: nothing does.
std::string lost_choices(const Store& store, const PresetBinding& binding, const Blend& blend);

Recalled recall(Store& store, const PresetBinding& binding, const Blend& blend);

}  // namespace limber
