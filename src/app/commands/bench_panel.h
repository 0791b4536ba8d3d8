// Benchmark of the panel with 17 000 parts.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// Processor time of a frame, without drawing. [main]
nlohmann::ordered_json bench_panel(const BenchOptions& options);

}  // namespace limber
