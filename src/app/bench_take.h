// What recording a take costs, and how fast one is replayed.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// 16 arms of 17 parts, and 17 messages of one number each tick (1000 a second): what a take of that costs a tick and
/// the disk, and the processor's time of its replay beside that of the show.
nlohmann::ordered_json bench_take(const BenchOptions& options);

}  // namespace limber
