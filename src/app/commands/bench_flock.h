// Benchmark of group behaviors: many bodies that follow their neighbors.
#pragma once

#include "app/commands/bench.h"

namespace limber {

/// `bodies` one-part bodies with about 30 neighbors each: time per tick of cohesion and alignment, and of the whole
/// tick.
nlohmann::ordered_json bench_flock(int bodies, const BenchOptions& options);

}  // namespace limber
