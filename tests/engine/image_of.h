// Requests a value snapshot from an engine that is ticked by the test.
#pragma once

#include <memory>

#include "engine/show.h"

namespace limber::engine::test {

/// Ticks until there is a snapshot newer than this call: they take at most 1 % of the time, so it may be some hundred
/// ticks.
inline std::shared_ptr<const ValueSnapshot> make_value_snapshot(Show& show) {
  const std::uint64_t request = show.link.request_value_snapshot();
  std::shared_ptr<const ValueSnapshot> snapshot;
  for (int i = 0; i < 1000000; i++) {
    show.ticks(1);
    snapshot = show.link.value_snapshots.read();
    if (snapshot != nullptr && snapshot->request >= request) return snapshot;
  }
  ADD_FAILURE() << "no value snapshot is made";
  return snapshot;
}

}  // namespace limber::engine::test
