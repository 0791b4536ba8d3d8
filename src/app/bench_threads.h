// The bench of two threads beside one.
#pragma once

#include "app/bench.h"

namespace limber {

/// The same arms ticked by one thread and by two, in turn, 15 pairs of so many ticks: time by time, and whether both
/// came to the same state.
nlohmann::ordered_json bench_threads(const BenchOptions& options);

}  // namespace limber
