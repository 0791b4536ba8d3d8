// Benchmarks of Lua behaviors: against the equivalent built-in ones, and many small ones.
#pragma once

#include "app/commands/bench.h"

namespace limber {

/// Each built-in type and its Lua equivalent in behaviors_lua/, on 10 000 parts each, in the same ticks: times and
/// ratio.
nlohmann::ordered_json bench_lua_twin(const BenchOptions& options);
/// Instances that produce garbage: time of garbage collection per tick.
nlohmann::ordered_json bench_lua_garbage(const BenchOptions& options);
/// 1000 instances of a small Lua behavior: time of a tick.
nlohmann::ordered_json bench_lua_many(const BenchOptions& options);

}  // namespace limber
