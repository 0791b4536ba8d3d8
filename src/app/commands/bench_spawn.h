// Benchmark of spawning a thousand imported arms.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// Imports urdf/arm17.urdf, builds it, copies it 1000 times to different positions, and runs the first tick.
nlohmann::ordered_json bench_spawn(const BenchOptions& options);

}  // namespace limber
