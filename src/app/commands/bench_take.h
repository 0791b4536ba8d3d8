// Benchmark of recording and replaying takes.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// 16 arms of 17 parts and 17 one-number messages per tick (1000 a second): the cost of recording per tick and on disk,
/// and the processor time of a replay compared with that of the show.
nlohmann::ordered_json bench_take(const BenchOptions& options);

}  // namespace limber
