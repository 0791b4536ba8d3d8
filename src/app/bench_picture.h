// The bench of the picture: frames a second without a window.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// 1000 arms at 1920 × 1080 in the best quality, 16 at 640 × 360 in the lowest; or why there is no picture here. [main]
nlohmann::ordered_json bench_picture(const BenchOptions& options);

}  // namespace limber
