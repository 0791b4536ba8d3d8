// Benchmark of reloading a scene: the delay, and the effect on the ticks around it.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// A scene of 16 arms and one of 1000, saved repeatedly while they play: the time from the save to the first tick of
/// the new code, and the longest tick near it compared with the median.
nlohmann::ordered_json bench_reload(const BenchOptions& options);

}  // namespace limber
