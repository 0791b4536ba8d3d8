// Benchmark of rendering without a window: frames per second.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// 1000 arms at 1920 × 1080 in high quality, 16 at 640 × 360 in low quality; or an error if OpenGL is missing. [main]
nlohmann::ordered_json bench_picture(const BenchOptions& options);

}  // namespace limber
