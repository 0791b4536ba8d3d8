// Sets every property of a world to a random value of its range.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "properties/store.h"

namespace limber::engine::test {

/// Uses the setter; values that an object rejects stay. Returns the number of values set.
inline int set_random_values(Store& store, Random& random) {
  int count = 0;
  store.walk(store.root(), [&](NodeId id) {
    for (const Property& property : store.table(id).properties()) {
      if (property.kind != PropertyKind::setting || !property.stored()) continue;
      std::array<double, 4> values{};
      for (std::uint32_t i = 0; i < property.width; i++)
        values[i] = random.uniform(std::max(property.low(i), -50.0), std::min(property.high(i), 50.0));
      count += store.set(id, property, {values.data(), property.width}) ? 1 : 0;
    }
  });
  return count;
}

}  // namespace limber::engine::test
