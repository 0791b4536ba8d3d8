// Benchmark of two threads against one.
#pragma once

#include "app/commands/bench.h"

namespace limber {

/// Ticks the same arms with one thread and with two, alternating in 15 pairs of several ticks: both times, their ratio,
/// and whether the states are identical.
nlohmann::ordered_json bench_threads(const BenchOptions& options);

}  // namespace limber
