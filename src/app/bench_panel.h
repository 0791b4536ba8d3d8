// The bench of the panel: what a frame of it costs beside 17 000 parts.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// Without drawing: what the panel itself takes of the processor. [main]
nlohmann::ordered_json bench_panel(const BenchOptions& options);

}  // namespace limber
