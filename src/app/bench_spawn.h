// How long it takes until a thousand imported arms stand in the world.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// Imports urdf/arm17.urdf, builds it, copies it 1000 times to places of their own, and takes the first tick.
nlohmann::ordered_json bench_spawn(const BenchOptions& options);

}  // namespace limber
