// Benchmark of the history: checkpoints and rewinding.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// 1, 100 and 1000 arms of 17 parts, and 100 arms with forces from Lua: the time of a tick without and with a
/// checkpoint, the memory for 30 s of history, and the time of a rewind by a second.
nlohmann::ordered_json bench_history(const BenchOptions& options);

}  // namespace limber
