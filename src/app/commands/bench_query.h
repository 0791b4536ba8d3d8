// Benchmark of OSCQuery clients: their cost on the simulation's thread.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// 16 arms at 60 ticks a second, alternately without clients and while 100 WebSocket clients listen to 50 changing
/// values each: the processor time of the ticks, and the number of values sent.
nlohmann::ordered_json bench_query(const BenchOptions& options);

}  // namespace limber
