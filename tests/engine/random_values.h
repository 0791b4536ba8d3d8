// Every property of a world at some value of its range.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "params/store.h"

namespace limber::engine_test {

/// Through the door; what a thing can't take stays. The answer: how many values were set.
inline int set_at_random(Store& store, Random& random) {
  int count = 0;
  store.walk(store.root(), [&](NodeId id) {
    for (const Row& row : store.table(id).rows()) {
      if (row.kind != RowKind::property || !row.stored()) continue;
      std::array<double, 4> values{};
      for (std::uint32_t i = 0; i < row.width; i++)
        values[i] = random.uniform(std::max(row.low(i), -50.0), std::min(row.high(i), 50.0));
      count += store.set(id, row, {values.data(), row.width}) ? 1 : 0;
    }
  });
  return count;
}

}  // namespace limber::engine_test
