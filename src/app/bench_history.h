// What history costs: key states, and going back.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// 1, 100 and 1000 arms of 17 parts, and 100 that Lua pushes: a tick, one that takes a key state, what half a
/// minute would take of memory, and a rewind by a second.
nlohmann::ordered_json bench_history(const BenchOptions& options);

}  // namespace limber
