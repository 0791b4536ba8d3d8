// Behaviours in Lua beside the built-in ones that they repeat, and many small ones.
#pragma once

#include "app/bench.h"

namespace limber {

/// Each built-in type and its twin of behaviors_lua/, on 10 000 parts each, in the same ticks: time of a tick, ratio.
nlohmann::ordered_json bench_lua_twin(const BenchOptions& options);
/// Instances that leave garbage: what the collector adds to ticks.
nlohmann::ordered_json bench_lua_garbage(const BenchOptions& options);
/// 1000 instances of a small behaviour in Lua: time of a tick.
nlohmann::ordered_json bench_lua_many(const BenchOptions& options);

}  // namespace limber
