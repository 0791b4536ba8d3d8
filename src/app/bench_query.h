// OSCQuery's clients on this machine: what they cost the simulation's thread.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// 16 arms at 60 ticks a second, alone and while 100 WebSocket clients listen to 50 moving values each, by turns: the
/// processor time of the simulation's ticks, and how many values the clients get.
nlohmann::ordered_json bench_query(const BenchOptions& options);

}  // namespace limber
